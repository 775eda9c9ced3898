#pragma once

#include <Eigen/Core>

namespace telltale {

/// An interval of directions. Units: radians, clockwise from north. Source: Mardia and Jupp,
/// Directional Statistics, 2000.
struct CircularInterval {
  double centre_rad = 0.0;      ///< in [0, 2 pi)
  double half_width_rad = 0.0;  ///< in [0, pi]; pi: any direction
  bool or_opposite = false;     ///< or in the same interval about the opposite direction
};

/// The shortest interval of directions that holds a share `level` of a distribution; where that is
/// half of all or more, and an axis is known better than to a quarter, the axis: two intervals.
/// Shape of `probabilities`: one for each of n directions, k 2 pi / n from north. Requires: an even
/// number of them; none negative; their sum is 1; a level in (0, 1).
CircularInterval ShortestArc(const Eigen::ArrayXd& probabilities, double level);

/// The direction of a vector north and east that is known to `covariance`, by the delta method.
/// Requires: a level in (0, 1).
CircularInterval DirectionOf(const Eigen::Vector2d& vector, const Eigen::Matrix2d& covariance,
                             double level);

}  // namespace telltale
