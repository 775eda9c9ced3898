#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace telltale {

/// A direction that the data do not determine: a change of the unknowns along it changes no
/// measurement. Shapes: change, one per unknown in its own unit, with one for `unknowns.front()`
/// and zero outside `unknowns`.
struct InseparableDirection {
  std::vector<std::size_t> unknowns;  ///< of the direction, strongest first
  Eigen::VectorXd change;
  double condition_index = 0.0;  ///< infinite where there is no information at all
};

/// Which unknowns and directions an information matrix determines.
/// Shapes: root P x r, with r the number of determined directions.
struct Separability {
  Eigen::MatrixXd root;         ///< root root' is the inverse of the information within them
  std::vector<bool> separable;  ///< false where most of an unknown's variance lies outside
  std::vector<InseparableDirection> directions;
};

/// Model: the information, scaled to a unit diagonal so that units do not matter, is split by its
/// eigenvectors. Those of condition index sqrt(lambda_max / lambda) above the limit span the null
/// space. The null space is written as combinations with as few unknowns in common as possible
/// (reduced echelon form by the largest pivots). An unknown without information is a direction by
/// itself.
/// Shapes: information P x P, symmetric and positive semidefinite.
/// `raw`: the diagonal of the information if nothing else is unknown. A diagonal lost to rounding
/// against it counts as zero.
/// Source: Belsley, Kuh, Welsch, "Regression Diagnostics", 1980, chapter 3.
Separability Separate(const Eigen::MatrixXd& information, const Eigen::VectorXd& raw,
                      double condition_index_limit);

}  // namespace telltale
