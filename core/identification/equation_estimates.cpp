#include "telltale/core/identification/equation_estimates.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "telltale/core/estimation/regression/residual_autocovariance.hpp"

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool IsCollinear(const Excitation& excitation, std::size_t column) {
  return std::any_of(excitation.collinear.begin(), excitation.collinear.end(), [&](const auto& g) {
    return std::find(g.columns.begin(), g.columns.end(), column) != g.columns.end();
  });
}

/// A coefficient as long as nothing is known of it.
Coefficient UnknownCoefficient(Equation equation, const Regressor& regressor, double level) {
  Coefficient coefficient;
  coefficient.equation = equation;
  coefficient.regressor = regressor.name;
  coefficient.symbol = regressor.symbol;
  coefficient.unit = regressor.unit;
  coefficient.status = CoefficientStatus::kNotExcited;
  coefficient.standard_error = kInfinity;
  coefficient.interval = Unbounded(level);
  return coefficient;
}

/// Writes the coefficients of answered equation j, and where each stands in the stacked bounds (-1:
/// nowhere).
void WriteEquation(std::size_t j, const EquationEstimates& equation_estimates, const Bounds& bounds,
                   Identification& identification, std::vector<Eigen::Index>& places) {
  const Excitation& excitation = *equation_estimates.excitations[j];
  const EquationEstimate& estimate = *equation_estimates.estimates[j];
  const double level = bounds.intervals.front().level;
  const auto regressors = Regressors(excitation.equation, identification.parameterization);
  for (std::size_t column = 0; column < regressors.size(); ++column) {
    Coefficient coefficient = UnknownCoefficient(excitation.equation, regressors[column], level);
    if (IsCollinear(excitation, column)) coefficient.status = CoefficientStatus::kCollinear;
    Eigen::Index place = -1;
    const auto found = std::find(estimate.columns.begin(), estimate.columns.end(), column);
    if (found != estimate.columns.end()) {
      const Eigen::Index position = found - estimate.columns.begin();
      place = equation_estimates.first[j] + position;
      coefficient.estimate = estimate.theta[position];
      coefficient.status = IsCollinear(excitation, column) ? CoefficientStatus::kCollinear
                                                           : CoefficientStatus::kEstimated;
      if (bounds.estimable[static_cast<std::size_t>(place)]) {
        coefficient.standard_error = std::sqrt(bounds.covariance(place, place));
        coefficient.interval = bounds.intervals[static_cast<std::size_t>(place)];
      } else {
        coefficient.status = CoefficientStatus::kCollinear;
        place = -1;
      }
    }
    identification.coefficients.push_back(coefficient);
    places.push_back(place);
  }
}

Eigen::MatrixXd SpreadCovariance(const Eigen::MatrixXd& stacked,
                                 const std::vector<Eigen::Index>& places) {
  const auto size = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Index from = places[static_cast<std::size_t>(i)];
    if (from < 0) {
      covariance(i, i) = kInfinity;
      continue;
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      const Eigen::Index to = places[static_cast<std::size_t>(j)];
      if (to >= 0) covariance(i, j) = stacked(from, to);
    }
  }
  return covariance;
}

/// A time constant below zero is none. Where no lag is seen the replicates, linearised about that
/// end, say nothing of how long a lag could hide; the standard error does.
Coefficient WriteTimeConstant(const EquationEstimates& equation_estimates, const Bounds& bounds) {
  const LagEstimate& lag = *equation_estimates.lag;
  const Interval& interval = bounds.intervals.front();
  Coefficient coefficient;
  coefficient.symbol = "tau";
  coefficient.unit = "s";
  coefficient.status = CoefficientStatus::kEstimated;
  coefficient.estimate = lag.time_constant_s;
  coefficient.standard_error = std::sqrt(bounds.covariance(0, 0));
  coefficient.interval = {interval.level, std::max(interval.lower, 0.0), interval.upper};
  if (lag.profile) {
    coefficient.interval = {interval.level, lag.lag_at_lower_bound ? 0.0 : lag.profile->lower,
                            lag.profile->upper};
  } else if (lag.lag_at_lower_bound) {
    coefficient.interval = {interval.level, 0.0,
                            StudentInterval(lag.time_constant_s, coefficient.standard_error,
                                            bounds.degrees_of_freedom, interval.level)
                                .upper};
  }
  if (!bounds.estimable.front()) {
    coefficient.status = CoefficientStatus::kCollinear;
    coefficient.interval.upper = kInfinity;
  }
  return coefficient;
}

/// Of the time constant, first in the stacked bounds, with each coefficient.
Eigen::VectorXd SpreadTimeConstantCovariance(const Eigen::MatrixXd& stacked,
                                             const std::vector<Eigen::Index>& places) {
  Eigen::VectorXd covariance = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(places.size()));
  for (Eigen::Index i = 0; i < covariance.size(); ++i) {
    const Eigen::Index place = places[static_cast<std::size_t>(i)];
    if (place >= 0) covariance[i] = stacked(0, place);
  }
  return covariance;
}

}  // namespace

void AssessEquations(const std::array<EquationProblem, 3>& regressions,
                     const ExcitationLimits& limits, EquationEstimates& equation_estimates) {
  auto excitations = Assess(regressions, limits);
  for (std::size_t j = 0; j < regressions.size(); ++j) {
    if (!excitations[j]) {
      equation_estimates.refusals.push_back(excitations[j].error());
      continue;
    }
    for (const CollinearGroup& group : excitations[j]->collinear) {
      equation_estimates.refusals.push_back(Explain(group, regressions[j]));
    }
    equation_estimates.excitations[j] = *std::move(excitations[j]);
  }
}

EquationEstimates AssessExcitation(const PreparedDataset& dataset, RegressionOptions regression,
                                   const ExcitationLimits& limits) {
  regression.structure = Structure::kStaticQuadratic;
  EquationEstimates equation_estimates;
  AssessEquations(BuildRegression(dataset, regression).equations, limits, equation_estimates);
  return equation_estimates;
}

std::array<std::vector<std::size_t>, 3> ExcitedColumns(
    const EquationEstimates& equation_estimates) {
  std::array<std::vector<std::size_t>, 3> columns;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (equation_estimates.excitations[j]) columns[j] = equation_estimates.excitations[j]->excited;
  }
  return columns;
}

void PlaceEstimate(Equation equation, const std::vector<std::size_t>& columns,
                   const Eigen::VectorXd& theta, Eigen::Index first,
                   EquationEstimates& equation_estimates) {
  EquationEstimate estimate;
  estimate.equation = equation;
  estimate.columns = columns;
  estimate.theta = theta;
  estimate.estimable.assign(columns.size(), true);
  equation_estimates.first[IndexOf(equation)] = first;
  equation_estimates.estimates[IndexOf(equation)] = std::move(estimate);
}

Bounds StudentBounds(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                     double degrees_of_freedom, double level) {
  return StudentBounds(theta, covariance, Eigen::VectorXd::Ones(theta.size()), degrees_of_freedom,
                       level);
}

Bounds StudentBounds(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                     const Eigen::VectorXd& interval_factors, double degrees_of_freedom,
                     double level) {
  Bounds bounds;
  bounds.degrees_of_freedom = degrees_of_freedom;
  bounds.covariance = covariance;
  bounds.estimable.assign(static_cast<std::size_t>(theta.size()), true);
  for (Eigen::Index j = 0; j < theta.size(); ++j) {
    bounds.intervals.push_back(StudentInterval(
        theta[j], interval_factors[j] * std::sqrt(covariance(j, j)), degrees_of_freedom, level));
  }
  return bounds;
}

std::optional<Refusal> WarnOfFewClusters(Eigen::Index clusters) {
  constexpr Eigen::Index kFewestClusters = 15;
  if (clusters >= kFewestClusters) return std::nullopt;
  return Refusal{"bounds",
                 "rest on only " + std::to_string(clusters) + " independent segments of time, " +
                     std::to_string(kFewestClusters) + " are needed to trust them",
                 "record for longer"};
}

Refusal RefuseAllEquations(const std::vector<Refusal>& refusals) {
  std::ostringstream reasons;
  for (const Refusal& refusal : refusals) {
    reasons << (reasons.tellp() > 0 ? "; " : "") << refusal.subject << ": " << refusal.reason;
  }
  return {"model", "not one equation can be answered (" + reasons.str() + ")",
          refusals.empty() ? "record for longer" : refusals.front().advice};
}

SampleSize SizeOf(const Eigen::VectorXd& residual, std::span<const std::size_t> places,
                  std::size_t stride) {
  const double apart = RowsPerIndependentRow(residual, RunsOf(places, stride));
  return {places.size(), static_cast<double>(places.size()) / apart};
}

std::vector<ExcitationSummary> Summarise(const EquationEstimates& equation_estimates,
                                         Parameterization parameterization) {
  std::vector<ExcitationSummary> summaries;
  for (std::size_t j = 0; j < equation_estimates.excitations.size(); ++j) {
    if (!equation_estimates.excitations[j]) continue;
    summaries.push_back(Summarise(*equation_estimates.excitations[j],
                                  Regressors(kEquations[j], parameterization).size()));
    summaries.back().rows = equation_estimates.sizes[j].rows;
    summaries.back().effective_rows = equation_estimates.sizes[j].effective_rows;
  }
  return summaries;
}

VesselModel ModelOf(const EquationEstimates& equation_estimates,
                    const RegressionOptions& regression, Discretisation discretisation,
                    double sampling_period_s) {
  VesselModel model = VesselModel::OfZeros(regression.structure, regression.parameterization,
                                           discretisation, sampling_period_s);
  model.dead_zone = regression.dead_zone;
  if (equation_estimates.lag)
    model.thruster_time_constant_s = equation_estimates.lag->time_constant_s;
  for (const Equation equation : kEquations) {
    const auto& estimate = equation_estimates.estimates[IndexOf(equation)];
    if (estimate) model.theta[IndexOf(equation)](estimate->columns) = estimate->theta;
  }
  return model;
}

void WriteCoefficients(const EquationEstimates& equation_estimates, const Bounds& bounds,
                       Identification& identification) {
  std::vector<Eigen::Index> places;
  for (std::size_t j = 0; j < equation_estimates.estimates.size(); ++j) {
    if (equation_estimates.estimates[j])
      WriteEquation(j, equation_estimates, bounds, identification, places);
  }
  identification.covariance = SpreadCovariance(bounds.covariance, places);
  identification.joint = bounds.joint;
  if (!equation_estimates.lag) return;
  identification.thruster_time_constant = WriteTimeConstant(equation_estimates, bounds);
  identification.time_constant_covariance = SpreadTimeConstantCovariance(bounds.covariance, places);
}

}  // namespace telltale
