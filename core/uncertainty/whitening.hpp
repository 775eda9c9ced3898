#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/regression/parameter_block.hpp"

namespace telltale {

/// Coordinates z in which the errors x of each block are uncorrelated with variance one: x = map z,
/// z = inverse x. Shapes: map and inverse P x P, block diagonal.
/// The axes are those of the correlations, so that units make no difference. No axis joins two
/// blocks, because an ill-determined block would lend its size to the others.
struct Whitening {
  Whitening(const Eigen::MatrixXd& covariance, const std::vector<Block>& blocks);

  /// A covariance of x as one of z.
  Eigen::MatrixXd Of(const Eigen::MatrixXd& covariance) const;

  Eigen::MatrixXd map;
  Eigen::MatrixXd inverse;
};

}  // namespace telltale
