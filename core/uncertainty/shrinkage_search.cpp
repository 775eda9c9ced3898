#include "telltale/core/uncertainty/shrinkage_search.hpp"

#include <array>

namespace telltale {
namespace {

// In units of the expected distance of the truth from the estimate. Too much shrinkage gives models
// with smaller coefficients than the truth may have, whose bias is another.
constexpr std::array kPriorScales = {0.1, 0.5, 2.0, 8.0, 32.0, 128.0};
static_assert(kShrinkageLevels == kPriorScales.size() + 1, "the regularised fit comes last");

}  // namespace

RidgePosterior PosteriorAt(int shrinkage_level, const WeakFit& fit) {
  const auto level = static_cast<std::size_t>(shrinkage_level);
  if (level < kPriorScales.size()) return RidgePosteriorOf(fit, kPriorScales[level]);
  const Eigen::Index unknowns = fit.theta.size();
  return {fit.Regularised(), Eigen::MatrixXd::Zero(unknowns, unknowns)};
}

}  // namespace telltale
