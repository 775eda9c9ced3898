#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/estimation/regression/excitation_summary.hpp"
#include "telltale/core/identification/coefficient.hpp"
#include "telltale/core/identification/estimator.hpp"
#include "telltale/core/identification/manoeuvre_advice.hpp"
#include "telltale/core/identification/physical_model.hpp"
#include "telltale/core/identification/provenance.hpp"
#include "telltale/core/uncertainty/coverage.hpp"
#include "telltale/core/uncertainty/joint_bounds.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/regressors.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// Per-recording bias, docs/concepts/model.md (70): coefficients of "1", a constant disturbance in
/// body axes, and of "cos(psi)" and "sin(psi)", one to the north and east, in each equation.
struct RecordingBias {
  double start_s = 0.0;  ///< first and last prepared row
  double end_s = 0.0;
  std::vector<Coefficient> coefficients;
};

/// An effect that was added to a model by name, docs/guides/adding-an-effect.md.
struct AddedEffect {
  std::string effect;
  std::vector<double> values;  ///< one per parameter, in its order
};

/// A boat's model with bounds: the outcome that is published.
/// Shapes: coefficients in the order surge, sway, yaw and, within each, of Regressors(); an
/// equation that was refused has no coefficients and a refusal. covariance is square over all
/// coefficients; a NOT_EXCITED coefficient has infinite variance and zero covariances.
/// time_constant_covariance is that of the thruster time constant with each coefficient: empty in
/// the static structure, zero where NOT_EXCITED.
struct Identification {
  std::string vehicle_id;
  Structure structure = Structure::kUnknown;
  Parameterization parameterization = Parameterization::kUnknown;
  Estimator estimator = Estimator::kUnknown;
  double sampling_period_s = 0.0;
  DeadZone dead_zone;
  std::vector<Coefficient> coefficients;
  Eigen::MatrixXd covariance;
  std::optional<JointBounds> joint;  ///< where joint statements can be made
  std::optional<Coefficient> thruster_time_constant;
  Eigen::VectorXd time_constant_covariance;
  std::optional<Disturbance> disturbance;  ///< besides the propellers, where it is estimated
  /// Where each recording has a constant disturbance of its own: these, and the coefficients of the
  /// regressor "1" are their means.
  std::vector<RecordingBias> recording_bias;
  std::vector<AddedEffect> effects;  ///< that act on the boat besides its coefficients
  /// Simulation parameters, docs/concepts/model.md (18b): where a simulation with the estimates
  /// diverges, coefficients in their order within the ellipsoid, or within the bounds where there
  /// is none. Empty: the estimates.
  std::vector<double> simulation;
  /// The value that a simulation uses for the coefficient at `place`.
  double SimulationParameter(std::size_t place) const {
    return simulation.empty() ? coefficients[place].estimate : simulation[place];
  }
  WindowSummary window;
  std::vector<Refusal> refusals;
  Provenance provenance;
  std::vector<ExcitationSummary> excitation;  ///< of the answered equations, in their order
  std::vector<ManoeuvreAdvice> advice;        ///< best first; none where nothing is left open
  std::optional<CoverageCheck> coverage_check;
  std::optional<PhysicalModel> physical;  ///< of the structure kFossen alone, which always has one

  bool Has(Equation equation) const;

  /// Coefficients that are bounded at all.
  std::size_t Bounded() const;

  /// In the order of the coefficients.
  Eigen::VectorXd Estimates() const;
};

/// The squared radius of the ellipsoid of all bounded coefficients at the level of the intervals:
///   (theta - estimate)' covariance^-1 (theta - estimate) <= radius^2
/// over those of finite variance. Nothing where no joint statement can be made.
std::optional<double> SquaredRadius(const Identification& identification);

/// What the model says of the thrusters; its theta are empty.
VesselModel ThrustersOf(const Identification& identification);

/// The model without bounds, ready to simulate: with the simulation parameters.
/// Refuses when: an equation was refused, since a free run needs all three.
Result<VesselModel> ModelOf(const Identification& identification);

/// The same identification with its simulation parameters as estimates.
Identification WithSimulationParameters(Identification identification);

}  // namespace telltale
