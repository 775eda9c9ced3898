#pragma once

#include <cstddef>
#include <vector>

namespace telltale {

/// A coefficient belongs to a near dependency that carries more than this share of its variance.
/// Source: Belsley, Kuh, Welsch, "Regression Diagnostics", 1980, chapter 3.
inline constexpr double kDependencyVarianceShare = 0.5;

/// A coefficient belongs to an undetermined direction when its squared component along the
/// direction exceeds this.
inline constexpr double kUndeterminedShare = 1e-6;

/// Coefficients that the data move only together, as positions in the equation's regressors.
struct CollinearGroup {
  std::vector<std::size_t> columns;
  double condition_index = 0.0;
};

}  // namespace telltale
