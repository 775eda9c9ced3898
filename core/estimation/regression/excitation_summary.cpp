#include "telltale/core/estimation/regression/excitation_summary.hpp"

#include <cmath>
#include <limits>

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<CombinationTerm> LeastSeparable(const Excitation& excitation) {
  // Components below this share of the largest one are left out.
  constexpr double kNamed = 0.3;
  const Eigen::VectorXd worst = excitation.right_singular_vectors.rightCols<1>();
  Eigen::Index largest = 0;
  worst.cwiseAbs().maxCoeff(&largest);
  std::vector<CombinationTerm> terms;
  for (Eigen::Index j = 0; j < worst.size(); ++j) {
    const double weight = worst[j] / worst[largest];
    if (std::abs(weight) < kNamed) continue;
    terms.push_back({excitation.excited[static_cast<std::size_t>(j)], weight});
  }
  return terms;
}

}  // namespace

ExcitationSummary Summarise(const Excitation& excitation, std::size_t regressors) {
  ExcitationSummary summary;
  summary.equation = excitation.equation;
  const Eigen::VectorXd& s = excitation.singular_values;
  const double last = s[s.size() - 1];
  summary.condition = last > 0.0 ? s[0] / last : kInfinity;
  summary.variance_inflation.assign(regressors, kInfinity);
  for (Eigen::Index j = 0; j < s.size(); ++j) {
    const auto parts = excitation.right_singular_vectors.row(j).transpose().cwiseQuotient(s);
    const double inflation = excitation.rank == s.size() ? parts.squaredNorm() : kInfinity;
    summary.variance_inflation[excitation.excited[static_cast<std::size_t>(j)]] = inflation;
  }
  if (s.size() > 1) summary.least_separable = LeastSeparable(excitation);
  return summary;
}

}  // namespace telltale
