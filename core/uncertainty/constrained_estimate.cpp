#include "telltale/core/uncertainty/constrained_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/uncertainty/distributions.hpp"
#include "telltale/core/uncertainty/truncated_normal.hpp"

namespace telltale {
namespace {

// What the parameters would be with some of them at the ends of their ranges.
struct ConditionalAtEnds {
  ConditionalNormal law;
  double quantile;  ///< how far it counts to either side, in standard deviations
};

// With the parameters kept at their ends there, and parameter `at` at `end`.
ConditionalNormal GivenOneMoreEnd(const ConstrainedEstimate& estimate,
                                  std::vector<Eigen::Index> kept, Eigen::Index at, double end) {
  kept.push_back(at);
  Eigen::VectorXd values = estimate.estimate(kept);
  values[values.size() - 1] = end;
  return NormalGiven(estimate.estimate, estimate.covariance, kept, values);
}

// With those kept at their ends there, around which the others err to both sides, and with them
// each other one in turn whose law holds an end: off it the others err to one side.
std::vector<ConditionalAtEnds> ConditionalsAtEnds(const ConstrainedEstimate& estimate,
                                                  double level) {
  const std::vector<Eigen::Index> kept = estimate.KeptAtEnds();
  const ConditionalNormal with_kept =
      NormalGiven(estimate.estimate, estimate.covariance, kept, estimate.estimate(kept));
  const double two_sided = NormalQuantile(0.5 * (1.0 + level));
  const double one_sided = NormalQuantile(level);
  std::vector<ConditionalAtEnds> conditionals;
  if (!kept.empty()) conditionals.push_back({with_kept, two_sided});
  for (Eigen::Index i = 0; i < estimate.estimate.size(); ++i) {
    const double reach = two_sided * with_kept.standard_deviation[i];
    for (const double end : {estimate.least[i], estimate.greatest[i]}) {
      if (std::abs(estimate.estimate[i] - end) >= reach) continue;
      conditionals.push_back({GivenOneMoreEnd(estimate, kept, i, end), one_sided});
    }
  }
  return conditionals;
}

}  // namespace

std::vector<Eigen::Index> ConstrainedEstimate::KeptAtEnds() const {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < estimate.size(); ++i) {
    const bool beyond = unconstrained[i] < least[i] || unconstrained[i] > greatest[i];
    const bool ends = estimate[i] <= least[i] || estimate[i] >= greatest[i];
    if (beyond && ends) kept.push_back(i);
  }
  return kept;
}

Eigen::MatrixXd DrawsOf(const ConstrainedEstimate& estimate, std::size_t count,
                        std::uint64_t seed) {
  const Eigen::VectorXd mean = MeanBeforeTruncation(estimate.estimate, estimate.unconstrained,
                                                    estimate.covariance, estimate.KeptAtEnds());
  return DrawTruncatedNormal(mean, estimate.covariance, estimate.least, estimate.greatest,
                             estimate.estimate, count, seed);
}

std::vector<Interval> IntervalsOf(const ConstrainedEstimate& estimate, const Eigen::MatrixXd& draws,
                                  double level) {
  const std::vector<ConditionalAtEnds> at_ends = ConditionalsAtEnds(estimate, level);
  std::vector<Interval> intervals;
  for (Eigen::Index i = 0; i < draws.rows(); ++i) {
    const double least = estimate.least[i];
    const double greatest = estimate.greatest[i];
    const auto own = draws.row(i);
    Interval interval =
        IntervalWithin({own.begin(), own.end()}, estimate.estimate[i], level, least, greatest);
    for (const auto& [law, quantile] : at_ends) {
      const double half = quantile * law.standard_deviation[i];
      interval.lower = std::min(interval.lower, std::max(law.mean[i] - half, least));
      interval.upper = std::max(interval.upper, std::min(law.mean[i] + half, greatest));
    }
    intervals.push_back(interval);
  }
  return intervals;
}

}  // namespace telltale
