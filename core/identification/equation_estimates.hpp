#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/uncertainty/interval.hpp"
#include "telltale/core/uncertainty/joint_bounds.hpp"

namespace telltale {

/// The thrusters' lag as one of the estimates.
struct LagEstimate {
  double time_constant_s = 0.0;
  bool lag_at_lower_bound = false;  ///< the data bound it from above alone
  std::optional<Interval> profile =
      std::nullopt;  ///< where it stands in for the interval of Bounds
};

/// Rows, or windows, behind an equation's estimate.
struct SampleSize {
  std::size_t rows = 0;
  double effective_rows = 0.0;
};

/// Everything known about the equations before coefficients are written down. The stacked unknowns
/// are the time constant, if there is a lag, and then the coefficients of each estimated equation,
/// which begin at first[j].
struct EquationEstimates {
  std::array<std::optional<Excitation>, 3> excitations;
  std::array<std::optional<EquationEstimate>, 3> estimates;
  std::array<Eigen::Index, 3> first{};
  std::array<SampleSize, 3> sizes{};
  std::optional<LagEstimate> lag;
  std::vector<Refusal> refusals;

  bool Any() const {
    return std::any_of(excitations.begin(), excitations.end(), [](const auto& e) { return e; });
  }
};

/// Bounds of all stacked unknowns.
struct Bounds {
  double degrees_of_freedom = 0.0;
  Eigen::MatrixXd covariance;
  std::vector<Interval> intervals;
  std::vector<bool> estimable;
  std::optional<JointBounds> joint = std::nullopt;  ///< of all of them together, where known
};

/// What an estimator makes of a dataset: estimates, their bounds and what those rest on.
struct BoundedEstimates {
  Estimator estimator = Estimator::kUnknown;
  EquationEstimates equation_estimates;
  Bounds bounds;
  Provenance provenance;  ///< the fields that are the estimator's
  std::optional<Disturbance> disturbance;
  std::vector<RecordingBias> recording_bias;
};

/// Whether these equations can be estimated: writes the excitation of each, or a refusal, into
/// equation_estimates.
void AssessEquations(const std::array<EquationProblem, 3>& regressions,
                     const ExcitationLimits& limits, EquationEstimates& equation_estimates);

/// The same of a dataset; the thrusters' lag has no say in it.
EquationEstimates AssessExcitation(const PreparedDataset& dataset, RegressionOptions regression,
                                   const ExcitationLimits& limits);

/// By equation the columns that the data move; none where it is not estimated.
std::array<std::vector<std::size_t>, 3> ExcitedColumns(const EquationEstimates& equation_estimates);

/// Places the coefficients of one equation, estimated at these columns, in equation_estimates:
/// `first` is where they begin among the stacked unknowns.
void PlaceEstimate(Equation equation, const std::vector<std::size_t>& columns,
                   const Eigen::VectorXd& theta, Eigen::Index first,
                   EquationEstimates& equation_estimates);

/// Student's t about stacked unknowns of this covariance, all of them estimable.
Bounds StudentBounds(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                     double degrees_of_freedom, double level);

/// The same with intervals that are each so many times as long.
Bounds StudentBounds(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                     const Eigen::VectorXd& interval_factors, double degrees_of_freedom,
                     double level);

/// What to say where bounds rest on scores of fewer clusters than tell how an estimate varies.
std::optional<Refusal> WarnOfFewClusters(Eigen::Index clusters);

/// Refuses for all equations at once.
Refusal RefuseAllEquations(const std::vector<Refusal>& refusals);

/// The sample size behind residuals whose places in time follow each other at `stride`.
SampleSize SizeOf(const Eigen::VectorXd& residual, std::span<const std::size_t> places,
                  std::size_t stride);

/// What the data show of each estimated equation.
std::vector<ExcitationSummary> Summarise(const EquationEstimates& equation_estimates,
                                         Parameterization parameterization);

/// The model of the estimates; coefficients that were not sought are zero.
VesselModel ModelOf(const EquationEstimates& equation_estimates,
                    const RegressionOptions& regression, Discretisation discretisation,
                    double sampling_period_s);

/// Coefficients, covariance and time constant, in the order and with the places of Identification.
void WriteCoefficients(const EquationEstimates& equation_estimates, const Bounds& bounds,
                       Identification& identification);

}  // namespace telltale
