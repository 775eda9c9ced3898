#include "estimation/excitation_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<CombinationTerm> LeastSeparable(const Excitation& excitation) {
  // What takes part with less than this of the largest part is not worth naming.
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

/// The products of residuals `lag` apart, added up.
double Autocovariance(const Eigen::VectorXd& residual, std::span<const RowRange> runs,
                      std::size_t lag) {
  double sum = 0.0;
  for (const RowRange& run : runs) {
    if (run.size() <= lag) continue;
    const auto begin = static_cast<Eigen::Index>(run.begin);
    const auto count = static_cast<Eigen::Index>(run.size() - lag);
    sum += residual.segment(begin, count)
               .dot(residual.segment(begin + static_cast<Eigen::Index>(lag), count));
  }
  return sum;
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

double RowsPerIndependentRow(const Eigen::VectorXd& residual, std::span<const RowRange> runs) {
  const double squares = residual.squaredNorm();
  if (squares <= 0.0) return 1.0;
  std::size_t longest = 0;
  for (const RowRange& run : runs) longest = std::max(longest, run.size());
  double sum = -1.0;
  double least = kInfinity;
  for (std::size_t lag = 0; lag + 1 < longest; lag += 2) {
    const double pair =
        (Autocovariance(residual, runs, lag) + Autocovariance(residual, runs, lag + 1)) / squares;
    if (pair <= 0.0) break;
    least = std::min(least, pair);
    sum += 2.0 * least;
  }
  return std::max(1.0, sum);
}

std::vector<RowRange> RunsOf(std::span<const std::size_t> places, std::size_t stride) {
  std::vector<RowRange> runs;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool follows = i > 0 && places[i] == places[i - 1] + stride;
    if (!follows) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

}  // namespace telltale
