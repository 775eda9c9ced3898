#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/estimation/regression/excitation_summary.hpp"
#include "telltale/core/identification/model_change.hpp"
#include "telltale/core/uncertainty/coverage.hpp"
#include "telltale/core/uncertainty/interval.hpp"
#include "telltale/core/uncertainty/joint_bounds.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

enum class Estimator { kUnknown, kOneStep, kWeakIv, kOutputError };

std::string_view Name(Estimator estimator);

/// kEstimated: estimate and bounds come from the data.
/// kNotExcited: the data never moved this regressor; estimate 0, standard error and bounds
/// infinite. kCollinear: the data move it only together with others; its bounds are honest but it
/// should be read with its partners, which a refusal names.
enum class CoefficientStatus { kUnknown, kEstimated, kNotExcited, kCollinear };

std::string_view Name(CoefficientStatus status);

/// One coefficient with its bounds, continuous-time SI.
struct Coefficient {
  Equation equation = Equation::kUnknown;
  std::string regressor;
  std::string symbol;
  double estimate = 0.0;
  double standard_error = 0.0;
  Interval interval;
  std::string unit;
  CoefficientStatus status = CoefficientStatus::kUnknown;
};

/// What the identification rests on.
struct WindowSummary {
  double start_s = 0.0;
  double end_s = 0.0;
  std::size_t samples = 0;  ///< prepared rows
  std::size_t segments = 0;
  RejectCounts rejected;
};

/// What pushed the boat steadily in one of several recordings, docs/concepts/model.md (70):
/// coefficients of "1", which turns with the boat, and of "cos(psi)" and "sin(psi)", which stand to
/// the north and east, in each equation.
struct RecordingBias {
  double start_s = 0.0;  ///< first and last prepared row
  double end_s = 0.0;
  std::vector<Coefficient> coefficients;
};

/// How it was made, enough to make it again.
struct Provenance {
  std::string preset;        ///< of the data preparation
  std::string bounds_basis;  ///< what standard errors and intervals rest on, in words
  std::size_t bootstrap_replicates = 0;
  std::size_t bootstrap_failures = 0;  ///< replicates that could not be solved
  std::uint64_t seed = 0;
  std::string software_version;
  std::size_t parametric_replicates = 0;          ///< simulated repeats that were identified again
  std::size_t parametric_replicate_failures = 0;  ///< those that could not be
  std::string estimator_choice;  ///< why this estimator, a sentence; empty where it was named
  /// Standard errors by cluster over naive ones, of output error; 0 where it was not judged. Well
  /// above one something else than the sensors keeps model and measurement apart.
  double misspecification = 0.0;
  std::size_t clusters = 0;  ///< independent segments of time behind the covariance, 0: not so made
  std::optional<ModelChange> change;  ///< against an earlier model, where there is one
};

/// What a manoeuvre is expected to do to the bounds of one coefficient.
struct ExpectedBounds {
  Equation equation = Equation::kUnknown;
  std::string regressor;
  std::string unit;
  double estimate = 0.0;
  double half_width = 0.0;           ///< of the interval now; infinite where not known
  double expected_half_width = 0.0;  ///< once the manoeuvre is in the data too; likewise
};

/// A manoeuvre that would tell more of the coefficients the data leave open.
struct ManoeuvreAdvice {
  std::string manoeuvre;
  std::string how;
  double duration_s = 0.0;
  double expected_nats = 0.0;            ///< information about those coefficients, (66)
  std::vector<ExpectedBounds> expected;  ///< of those coefficients, most shrunk first
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
  std::optional<JointBounds> joint;  ///< where joint statements can be made: what they take
  std::optional<Coefficient> thruster_time_constant;
  Eigen::VectorXd time_constant_covariance;
  std::optional<Disturbance> disturbance;  ///< what else moved the boat, where that was judged
  /// Where each recording has a steady disturbance of its own: these, and the coefficients of the
  /// regressor "1" are their means.
  std::vector<RecordingBias> recording_bias;
  std::vector<AddedEffect> effects;  ///< that act on the boat besides its coefficients
  /// Where the estimates run away, what a simulation takes in their place, in the order of the
  /// coefficients and within the ellipsoid, or the bounds where there is none:
  /// docs/concepts/model.md (18b). Empty: the estimates.
  std::vector<double> simulation;
  /// What a simulation takes for the coefficient at that place.
  double SimulationParameter(std::size_t place) const {
    return simulation.empty() ? coefficients[place].estimate : simulation[place];
  }
  WindowSummary window;
  std::vector<Refusal> refusals;
  Provenance provenance;
  std::vector<ExcitationSummary> excitation;  ///< of the answered equations, in their order
  std::vector<ManoeuvreAdvice> advice;        ///< best first; none where nothing is left open
  std::optional<CoverageCheck> coverage_check;

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

/// The numbers without the bounds, ready to simulate: `sailed` where there are such.
/// Refuses when: an equation was refused, since a free run needs all three.
Result<VesselModel> ModelOf(const Identification& identification);

/// The same with what it is sailed with for estimates, for who knows nothing of bounds.
Identification WithSimulationParameters(Identification identification);

}  // namespace telltale
