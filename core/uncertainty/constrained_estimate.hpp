#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {

/// An estimate of parameters within their ranges, whose law without the ranges is normal.
/// Requires: least <= estimate <= greatest, a positive definite covariance.
struct ConstrainedEstimate {
  Eigen::VectorXd estimate;
  Eigen::VectorXd unconstrained;  ///< where the data would put it without the ranges
  Eigen::MatrixXd covariance;
  Eigen::VectorXd least;
  Eigen::VectorXd greatest;

  /// The parameters that the data put beyond an end of their range, where the estimate has them.
  std::vector<Eigen::Index> KeptAtEnds() const;
};

/// Draws within the ranges, one a column. The same seed gives the same draws.
Eigen::MatrixXd DrawsOf(const ConstrainedEstimate& estimate, std::size_t count, std::uint64_t seed);

/// An interval for each parameter by itself: IntervalWithin() of its draws. Draws of a parameter
/// lie on one side of an end of its range, on average away from it, and take those that depend on
/// it along, though its truth may be at the end. An interval therefore also holds what its
/// parameter would be with another one at an end that the data leave possible, as one by the
/// profile likelihood does.
std::vector<Interval> IntervalsOf(const ConstrainedEstimate& estimate, const Eigen::MatrixXd& draws,
                                  double level);

}  // namespace telltale
