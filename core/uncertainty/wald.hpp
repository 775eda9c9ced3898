#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// Estimates of p coefficients with their covariance. clusters: how many independent clusters the
/// covariance was estimated from, 0 where it counts as known. A coefficient of infinite variance is
/// not known at all.
struct Estimates {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  std::size_t clusters = 0;
};

/// How one coefficient differs, first less second.
struct CoefficientDifference {
  std::size_t index = 0;  ///< in theta
  double difference = 0.0;
  double standard_error = 0.0;
  double p_value =
      1.0;  ///< of this coefficient alone, two-sided, not corrected for looking at many
};

/// Shapes: differences, combination one entry for each coefficient compared.
struct WaldTest {
  double statistic = 0.0;                      ///< d' V^+ d
  std::size_t degrees_of_freedom = 0;          ///< rank of V
  double covariance_degrees_of_freedom = 0.0;  ///< of V itself; infinite where it counts as known
  double p_value = 1.0;                        ///< that models of one boat differ this much
  std::vector<CoefficientDifference> differences;  ///< the most significant first
  /// The combination sum_i combination[i] d_i that differs most, |.| in its own standard errors
  /// being sqrt(statistic): weights in the order of `differences`, each for a difference in units
  /// of its standard error, of unit norm.
  Eigen::VectorXd combination;
};

/// The Wald test of theta1 = theta2
/// over the coefficients both know: d = theta1 - theta2, V = Sigma1 + Sigma2.
/// Rank: eigenvalues of V scaled to unit diagonal, above 1e-10 of the largest; the test is of the
/// directions that V spans, and no verdict depends on units.
/// Distribution: chi-square with rank degrees of freedom where both covariances count as known.
/// Else V counts as a sum of two Wishart matrices with clusters - 1 degrees of freedom each, and
/// (nu - q + 1) / (nu q) statistic as F with q and nu - q + 1, nu from Krishnamoorthy and Yu's
/// affine-invariant approximation.
/// Refuses when: no coefficient is shared; a difference has no positive variance; or the
/// clusters are too few for a joint test of so many coefficients, nu < q + 1.
/// Requires: both over the same p, covariances symmetric.
/// Source: Krishnamoorthy, Yu, "Modified Nel and Van der Merwe test for the multivariate
/// Behrens-Fisher problem", Statistics & Probability Letters 66 (2004).
Result<WaldTest> TestEquality(const Estimates& first, const Estimates& second);

}  // namespace telltale
