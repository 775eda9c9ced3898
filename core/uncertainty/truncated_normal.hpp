#pragma once

#include <cstddef>
#include <cstdint>

#include <vector>

#include <Eigen/Core>

namespace telltale {

/// Draws from a normal law that is truncated to a box, one a column: Gibbs sampling from `start`,
/// five sweeps between draws, of the variables that a Cholesky factor makes independent but for the
/// limits: correlation does not slow it down. Determinism: the same seed gives the same draws.
/// Requires: a positive definite covariance, least <= start <= greatest.
/// Source: Rodriguez-Yam, Davis and Scharf, Efficient Gibbs sampling of truncated multivariate
/// normal with application to constrained linear regression, Colorado State University, 2004.
Eigen::MatrixXd DrawTruncatedNormal(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                                    const Eigen::VectorXd& least, const Eigen::VectorXd& greatest,
                                    const Eigen::VectorXd& start, std::size_t count,
                                    std::uint64_t seed);

/// The covariance of the normal law about `mean` whose truncation to a box has the standard
/// deviations of `truncated`, to some percent: that covariance, its deviations scaled one by one by
/// what draws of it fall short of. Its correlations are kept. Determinism: the draws are the same
/// every time. Requires: as DrawTruncatedNormal(), with `mean` in the box.
Eigen::MatrixXd CovarianceBeforeTruncation(const Eigen::VectorXd& mean,
                                           const Eigen::MatrixXd& truncated,
                                           const Eigen::VectorXd& least,
                                           const Eigen::VectorXd& greatest);

/// The mean of a normal law whose variables `kept` lie beyond an end of their range at
/// `unconstrained`, such that the others have the mean `estimate` given that those are at their
/// ends, which `estimate` has them at. An estimate under constraints has them there by the shape of
/// its own weights, which need not be that of `covariance`. Without `kept`: `unconstrained`.
/// Requires: a positive definite covariance of those kept.
Eigen::VectorXd MeanBeforeTruncation(const Eigen::VectorXd& estimate,
                                     const Eigen::VectorXd& unconstrained,
                                     const Eigen::MatrixXd& covariance,
                                     const std::vector<Eigen::Index>& kept);

/// Means and standard deviations of the variables of a normal law, those of some of them given.
struct ConditionalNormal {
  Eigen::VectorXd mean;
  Eigen::VectorXd standard_deviation;  ///< 0 of those that are given
};

/// The law of `mean` and `covariance` where the variables `given` have `values`, one each.
/// Requires: a positive definite covariance of those given.
ConditionalNormal NormalGiven(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                              const std::vector<Eigen::Index>& given,
                              const Eigen::VectorXd& values);

}  // namespace telltale
