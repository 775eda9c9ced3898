#include "telltale/core/identification/weak_iv_reported_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace telltale {
namespace {

std::size_t ConstantOf(std::span<const Regressor> regressors) {
  const auto found = std::find_if(regressors.begin(), regressors.end(),
                                  [](const Regressor& r) { return r.name == "1"; });
  return static_cast<std::size_t>(found - regressors.begin());
}

Coefficient AsCoefficient(const ReportedParameters::Term& term, const Eigen::VectorXd& reported,
                          const Bounds& bounds) {
  const auto regressors = Regressors(term.equation, Parameterization::kPropeller);
  const Regressor& constant = regressors[ConstantOf(regressors)];
  Coefficient coefficient;
  coefficient.equation = term.equation;
  coefficient.regressor = RecordingBiasTermName(term.term);
  constexpr std::array<const char*, 3> kSuffixes = {"", "_c", "_s"};
  coefficient.symbol = std::string(constant.symbol) + kSuffixes[term.term];
  coefficient.estimate = reported[term.place];
  coefficient.standard_error = std::sqrt(bounds.covariance(term.place, term.place));
  coefficient.interval = bounds.intervals[static_cast<std::size_t>(term.place)];
  coefficient.unit = constant.unit;
  coefficient.status = CoefficientStatus::kEstimated;
  return coefficient;
}

}  // namespace

ReportedParameters ReportedParametersOf(const WeakFit& fit) {
  ReportedParameters reported_parameters;
  std::vector<Eigen::RowVectorXd> coefficients;
  std::vector<Eigen::RowVectorXd> terms;
  const auto unit = [&](Eigen::Index place) -> Eigen::RowVectorXd {
    return Eigen::RowVectorXd::Unit(fit.theta.size(), place);
  };
  Eigen::Index next = 0;
  if (fit.time_constant_s) coefficients.push_back(unit(next++));
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const auto regressors = Regressors(kEquations[j], fit.problem.parameterization);
    const std::size_t each = fit.problem.recording_bias_terms.PerRecording();
    Eigen::RowVectorXd sum_of_constants = Eigen::RowVectorXd::Zero(fit.theta.size());
    for (const std::size_t column : fit.equations[j]->columns) {
      if (column < regressors.size()) {
        reported_parameters.columns[j].push_back(column);
        coefficients.push_back(unit(next++));
        continue;
      }
      const std::size_t place = column - regressors.size();
      if (place % each == 0) sum_of_constants += unit(next);
      reported_parameters.terms.push_back({kEquations[j], place / each, place % each, 0});
      terms.push_back(unit(next++));
    }
    if (sum_of_constants.isZero()) continue;
    reported_parameters.columns[j].push_back(ConstantOf(regressors));
    coefficients.emplace_back(sum_of_constants / sum_of_constants.sum());
  }
  reported_parameters.map.resize(static_cast<Eigen::Index>(coefficients.size() + terms.size()),
                                 fit.theta.size());
  Eigen::Index row = 0;
  for (const Eigen::RowVectorXd& of_coefficient : coefficients) {
    reported_parameters.map.row(row++) = of_coefficient;
  }
  for (std::size_t i = 0; i < terms.size(); ++i) {
    reported_parameters.terms[i].place = row;
    reported_parameters.map.row(row++) = terms[i];
  }
  return reported_parameters;
}

std::vector<RecordingBias> RecordingBiasesOf(const ReportedParameters& reported_parameters,
                                             const Eigen::VectorXd& reported, const Bounds& bounds,
                                             const PreparedDataset& dataset) {
  std::vector<RecordingBias> all;
  if (reported_parameters.terms.empty()) return all;
  all.resize(dataset.Recordings());
  for (std::size_t s = dataset.segments.size(); s-- > 0;) {
    RecordingBias& of_this = all[dataset.RecordingOf(s)];
    const RowRange& segment = dataset.segments[s];
    of_this.start_s = dataset.rows[segment.begin].time_s;
    of_this.end_s = std::max(of_this.end_s, dataset.rows[segment.end - 1].time_s);
  }
  for (const ReportedParameters::Term& term : reported_parameters.terms) {
    all[term.recording].coefficients.push_back(AsCoefficient(term, reported, bounds));
  }
  return all;
}

}  // namespace telltale
