#pragma once

#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// Whether every velocity stays inside its limit: |u| < limits.u, |v| < limits.v, |r| < limits.r.
/// False for NaN.
bool Within(const Nu& nu, const Nu& limits);

/// The limit past which a simulation has diverged, for a boat whose velocities were measured.
/// Units: m/s for u and v, rad/s for r.
struct RelativeDivergence {
  double times_fastest = 0.0;  ///< of the largest absolute velocity measured, each by itself
  double at_least = 0.0;       ///< the lowest limit, in each velocity's unit: for boats at rest

  Nu LimitsFor(const Nu& fastest) const;
};

/// The limit past which a simulation has diverged, for any boat.
struct AbsoluteDivergence {
  double speed_mps = 0.0;  ///< of hypot(u, v)
  double yaw_rate_radps = 0.0;

  /// True for NaN too.
  bool Exceeds(const Nu& nu) const;
};

/// A free run of a model over its own recording, docs/concepts/model.md (18a).
inline constexpr RelativeDivergence kFreeRunDivergence{2.0, 0.5};

/// A synthetic dataset: wider than a free run's, since disturbances are drawn anew.
inline constexpr RelativeDivergence kSyntheticDatasetDivergence{3.0, 0.5};

/// The simulated velocities behind instruments, which are clamped there and not given up.
inline constexpr RelativeDivergence kInstrumentDivergence{2.0, 0.0};

/// A shooting segment within the solver, each velocity by itself (m/s, rad/s).
inline constexpr Nu kShootingLimits{50.0, 50.0, 50.0};

/// A manoeuvre simulated to find what it would separate.
inline constexpr AbsoluteDivergence kSimulatedManoeuvreDivergence{20.0, 10.0};

/// A simulation of given commands, and the error of a free run as tables print it.
inline constexpr AbsoluteDivergence kOpenLoopDivergence{100.0, 100.0};

/// The largest error of a free run that residuals hold: metres, radians.
inline constexpr double kLargestFreeRunResidual = 1e3;

}  // namespace telltale
