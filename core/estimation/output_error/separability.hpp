#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace telltale {

/// A direction that data say nothing of: change the unknowns along it, and nothing measured moves.
/// Shapes: change, one per unknown in its own unit, that of `unknowns.front()` being one; zero
/// outside `unknowns`.
struct InseparableDirection {
  std::vector<std::size_t> unknowns;  ///< that take part, the strongest first; one alone is unseen
  Eigen::VectorXd change;
  double condition_index = 0.0;  ///< infinite where nothing at all is said
};

/// What an information matrix can tell apart.
/// Shapes: root P x r, r the directions told apart.
struct Separability {
  Eigen::MatrixXd root;         ///< root root' is the inverse of the information over those
  std::vector<bool> separable;  ///< false where most of an unknown's variance is not in there
  std::vector<InseparableDirection> directions;
};

/// Model: information scaled to a unit diagonal, so that units do not matter, and split by its
/// eigenvectors; those of condition index sqrt(lambda_max / lambda) above the limit are null. The
/// null space is written as combinations with as few unknowns in common as can be (reduced echelon
/// form by the largest pivots). An unknown with no information of its own is a direction by itself.
/// Shapes: information P x P, symmetric and positive semidefinite.
/// `raw`: the diagonal that the information would have were nothing else unknown; a diagonal lost
/// to rounding against it counts as zero.
/// Source: Belsley, Kuh, Welsch, "Regression Diagnostics", 1980, chapter 3.
Separability Separate(const Eigen::MatrixXd& information, const Eigen::VectorXd& raw,
                      double condition_index_limit);

}  // namespace telltale
