#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/estimation/output_error/shared_unknowns.hpp"
#include "telltale/core/estimation/output_error/shooting_plan.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"
#include "telltale/core/vessel/thrust_terms.hpp"

namespace telltale {

/// Thrust and its derivative by the time constant.
struct ThrustWithSlope {
  ThrustTerms now;
  ThrustTerms by_lag;
};

/// Thrust at the start, the middle and the end of a step. The middle is such that Simpson's rule
/// gives the exact mean of the step, however short the lag.
struct ThrustOverStep {
  ThrustWithSlope start, middle, end;
};

/// The thrusters of a shooting segment, which follow its commands through the first-order lag. They
/// start settled on the oldest command that they remember.
class SegmentThrusters {
 public:
  SegmentThrusters(const ShootingSegment& shooting_segment, std::optional<double> time_constant_s);

  ThrustOverStep Advance(const ThrustRegressors& steady_thrust, double duration_s);

 private:
  std::optional<double> time_constant_s_;
  ThrustWithSlope now_;
};

/// The columns of a sensitivity: the three initial velocities, then the shared unknowns, which are
/// the time constant and at most 35 coefficients; made even.
inline constexpr Eigen::Index kSensitivityColumns = 40;
inline constexpr Eigen::Index kFirstShared = 3;

/// Derivatives of x, y, psi, u, v, r by the initial velocities and the shared unknowns.
using Sensitivity = Eigen::Matrix<double, 6, kSensitivityColumns, Eigen::RowMajor>;

struct SensitiveState {
  ShootingState state;
  Sensitivity sensitivity;

  Nu Velocity() const { return {state[3], state[4], state[5]}; }
};

/// The equations of motion and their variational equations, docs/concepts/model.md (51).
class VariationalDynamics {
 public:
  /// `varied`: whether the sensitivity is integrated too. Keeps a reference to `unknowns`.
  VariationalDynamics(const SharedUnknowns& unknowns, const Eigen::VectorXd& theta, bool varied);

  /// One Runge-Kutta step of order four. The sensitivity takes the same steps as the state, so it
  /// is the exact derivative of the integrated state.
  SensitiveState Step(const SensitiveState& from, const ThrustOverStep& thrust, double h) const;

 private:
  SensitiveState Along(const SensitiveState& from, const SensitiveState& slope, double h) const;
  SensitiveState Slope(const SensitiveState& at, const ThrustWithSlope& thrust) const;
  void AddShared(const Nu& nu, const ThrustRegressors& applied, const ThrustRegressors& by_lag,
                 Sensitivity& sensitivity) const;

  BodyDynamics dynamics_;
  const SharedUnknowns& unknowns_;
  bool varied_;
  std::array<Eigen::Index, 3> first_{};
};

}  // namespace telltale
