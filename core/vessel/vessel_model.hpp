#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// How a model's coefficients turn into the next state.
/// kForwardEuler: nu(k+1) = nu(k) + h nu_dot(k), the paper's discrete model, which is what one-step
/// least squares fits; kContinuous: nu_dot integrated accurately.
enum class Discretisation { kUnknown, kForwardEuler, kContinuous };

/// A boat's model with numbers in it: what simulation and validation need, without any bound.
/// Model: nu_dot_j = Phi_j(nu, delta) theta_j, docs/concepts/model.md (10)..(12).
/// Shapes and units: theta[j] has one SI coefficient per entry of Regressors(j).
struct VesselModel {
  Structure structure = Structure::kUnknown;
  Parameterization parameterization = Parameterization::kUnknown;
  Discretisation discretisation = Discretisation::kUnknown;
  double sampling_period_s = 0.0;        ///< h of the discrete model
  std::array<Eigen::VectorXd, 3> theta;  ///< surge, sway, yaw
  DeadZone dead_zone;
  std::optional<double> thruster_time_constant_s;  ///< first-order dynamic structure only

  /// A model whose coefficients are all zero, to be filled in.
  static VesselModel OfZeros(Structure structure, Parameterization parameterization,
                             Discretisation discretisation, double sampling_period_s = 0.0);

  /// The propeller regressors that a command held for ever leads to.
  ThrustRegressors SteadyThrust(const PropellerCommand& delta) const;

  /// The propeller regressors `elapsed_s` after `delta` was applied to thrusters that stood at
  /// `thrust`: at once the steady ones in the static structure, an exponential approach in the
  /// dynamic one.
  ThrustRegressors ThrustAfter(const ThrustRegressors& thrust, const PropellerCommand& delta,
                               double elapsed_s) const;

  /// Their mean while `delta` is held for `elapsed_s`: what a forward Euler step of that length
  /// feels.
  ThrustRegressors MeanThrust(const ThrustRegressors& thrust, const PropellerCommand& delta,
                              double elapsed_s) const;

  /// nu_dot at a velocity under given propeller regressors.
  NuDot AccelerationUnder(const ThrustRegressors& thrust, const Nu& nu) const;

  /// nu_dot with the propellers delivering the steady thrust of `delta`.
  NuDot Acceleration(const Nu& nu, const PropellerCommand& delta) const;
};

}  // namespace telltale
