#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/regressors.hpp"
#include "telltale/core/vessel/reverse_loss.hpp"

namespace telltale {

/// The rule by which a model's coefficients give the next state.
/// kForwardEuler: nu(k+1) = nu(k) + h nu_dot(k), the paper's discrete model, which is what one-step
/// least squares fits; kContinuous: nu_dot integrated accurately.
enum class Discretisation { kUnknown, kForwardEuler, kContinuous };

/// A boat's model with its coefficients and without their bounds, for simulation and validation.
/// Model: nu_dot_j = Phi_j(nu, delta) theta_j, docs/concepts/model.md (10)..(12).
/// Shapes and units: theta[j] has one SI coefficient per entry of Regressors(j).
struct VesselModel {
  Structure structure = Structure::kUnknown;
  Parameterization parameterization = Parameterization::kUnknown;
  Discretisation discretisation = Discretisation::kUnknown;
  double sampling_period_s = 0.0;        ///< h of the discrete model
  std::array<Eigen::VectorXd, 3> theta;  ///< surge, sway, yaw
  DeadZone dead_zone;
  /// Of the parameterization kPropeller only. The port propeller gives 1 - thrust_imbalance of the
  /// thrust of the coefficients, that to starboard 1 + thrust_imbalance.
  ReverseLoss reverse_loss;
  double thrust_imbalance = 0.0;
  std::optional<double> thruster_time_constant_s;  ///< first-order dynamic structure only

  /// A model whose coefficients are all zero, to be filled in.
  static VesselModel OfZeros(Structure structure, Parameterization parameterization,
                             Discretisation discretisation, double sampling_period_s = 0.0);

  /// The propeller regressors that the thrust settles to under a held command, the imbalance in
  /// them.
  ThrustRegressors SteadyThrust(const PropellerCommand& delta) const;

  /// The propeller regressors `elapsed_s` after `delta` was applied to thrusters at `thrust`. They
  /// are the steady ones at once in the static structure and approach them exponentially in the
  /// dynamic one.
  ThrustRegressors ThrustAfter(const ThrustRegressors& thrust, const PropellerCommand& delta,
                               double elapsed_s) const;

  /// The mean of these regressors while `delta` is held for `elapsed_s`, which a forward Euler step
  /// of that length takes.
  ThrustRegressors MeanThrust(const ThrustRegressors& thrust, const PropellerCommand& delta,
                              double elapsed_s) const;

  /// The same regressors less what the reverse loss takes at speed u through the water.
  ThrustRegressors ThrustAt(double u, const ThrustRegressors& thrust) const;

  /// nu_dot at a velocity under given propeller regressors.
  NuDot AccelerationUnder(const ThrustRegressors& thrust, const Nu& nu) const;

  /// nu_dot at a velocity under the steady thrust of `delta`.
  NuDot Acceleration(const Nu& nu, const PropellerCommand& delta) const;
};

}  // namespace telltale
