#include "telltale/core/identification/weak_iv_publication.hpp"

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

Coefficient AsCoefficient(const WeakIvPublication::Term& term, const Eigen::VectorXd& published,
                          const Bounds& bounds) {
  const auto regressors = Regressors(term.equation, Parameterization::kPropeller);
  const Regressor& constant = regressors[ConstantOf(regressors)];
  Coefficient coefficient;
  coefficient.equation = term.equation;
  coefficient.regressor = SteadyTermName(term.term);
  constexpr std::array<const char*, 3> kSuffixes = {"", "_c", "_s"};
  coefficient.symbol = std::string(constant.symbol) + kSuffixes[term.term];
  coefficient.estimate = published[term.place];
  coefficient.standard_error = std::sqrt(bounds.covariance(term.place, term.place));
  coefficient.interval = bounds.intervals[static_cast<std::size_t>(term.place)];
  coefficient.unit = constant.unit;
  coefficient.status = CoefficientStatus::kEstimated;
  return coefficient;
}

}  // namespace

WeakIvPublication PublicationOf(const WeakFit& fit) {
  WeakIvPublication publication;
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
    const std::size_t each = fit.problem.steady.PerRecording();
    Eigen::RowVectorXd sum_of_constants = Eigen::RowVectorXd::Zero(fit.theta.size());
    for (const std::size_t column : fit.equations[j]->columns) {
      if (column < regressors.size()) {
        publication.columns[j].push_back(column);
        coefficients.push_back(unit(next++));
        continue;
      }
      const std::size_t place = column - regressors.size();
      if (place % each == 0) sum_of_constants += unit(next);
      publication.terms.push_back({kEquations[j], place / each, place % each, 0});
      terms.push_back(unit(next++));
    }
    if (sum_of_constants.isZero()) continue;
    publication.columns[j].push_back(ConstantOf(regressors));
    coefficients.emplace_back(sum_of_constants / sum_of_constants.sum());
  }
  publication.map.resize(static_cast<Eigen::Index>(coefficients.size() + terms.size()),
                         fit.theta.size());
  Eigen::Index row = 0;
  for (const Eigen::RowVectorXd& of_coefficient : coefficients) {
    publication.map.row(row++) = of_coefficient;
  }
  for (std::size_t i = 0; i < terms.size(); ++i) {
    publication.terms[i].place = row;
    publication.map.row(row++) = terms[i];
  }
  return publication;
}

std::vector<RecordingOffsets> OffsetsOf(const WeakIvPublication& publication,
                                        const Eigen::VectorXd& published, const Bounds& bounds,
                                        const PreparedDataset& dataset) {
  std::vector<RecordingOffsets> all;
  if (publication.terms.empty()) return all;
  all.resize(dataset.Recordings());
  for (std::size_t s = dataset.stretches.size(); s-- > 0;) {
    RecordingOffsets& of_this = all[dataset.RecordingOf(s)];
    const RowRange& stretch = dataset.stretches[s];
    of_this.start_s = dataset.rows[stretch.begin].time_s;
    of_this.end_s = std::max(of_this.end_s, dataset.rows[stretch.end - 1].time_s);
  }
  for (const WeakIvPublication::Term& term : publication.terms) {
    all[term.recording].coefficients.push_back(AsCoefficient(term, published, bounds));
  }
  return all;
}

}  // namespace telltale
