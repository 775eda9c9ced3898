#include "uncertainty/wald.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "contract.hpp"

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSmallestEigenvalue = 1e-10;

std::vector<Eigen::Index> Shared(const Estimates& first, const Estimates& second) {
  std::vector<Eigen::Index> shared;
  for (Eigen::Index i = 0; i < first.theta.size(); ++i) {
    if (std::isfinite(first.covariance(i, i)) && std::isfinite(second.covariance(i, i))) {
      shared.push_back(i);
    }
  }
  return shared;
}

/// What one covariance takes from the degrees of freedom of their sum, given R'Sigma R where R'V R
/// is the identity.
double Share(const Eigen::MatrixXd& whitened, std::size_t segments) {
  if (segments == 0) return 0.0;
  return ((whitened * whitened).trace() + std::pow(whitened.trace(), 2)) /
         static_cast<double>(segments - 1);
}

double JointPValue(double statistic, double q, double nu) {
  if (std::isinf(nu)) {
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(q), statistic));
  }
  const boost::math::fisher_f law(q, nu - q + 1.0);
  return boost::math::cdf(boost::math::complement(law, statistic * (nu - q + 1.0) / (nu * q)));
}

/// The two-sided law of one scaled difference, nu by Welch and Satterthwaite.
double SinglePValue(double scaled, double nu) {
  if (std::isinf(nu)) {
    return 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), std::abs(scaled)));
  }
  return 2.0 *
         boost::math::cdf(boost::math::complement(boost::math::students_t(nu), std::abs(scaled)));
}

double WelchDegrees(double first_share, const Estimates& first, const Estimates& second) {
  double reciprocal = 0.0;
  if (first.segments > 0) {
    reciprocal += std::pow(first_share, 2) / static_cast<double>(first.segments - 1);
  }
  if (second.segments > 0) {
    reciprocal += std::pow(1.0 - first_share, 2) / static_cast<double>(second.segments - 1);
  }
  return reciprocal > 0.0 ? 1.0 / reciprocal : kInfinity;
}

}  // namespace

Result<WaldTest> TestEquality(const Estimates& first, const Estimates& second) {
  const Eigen::Index p = first.theta.size();
  Require(second.theta.size() == p && first.covariance.rows() == p &&
              first.covariance.cols() == p && second.covariance.rows() == p &&
              second.covariance.cols() == p,
          "estimates and covariances of the same coefficients");
  Require(first.segments != 1 && second.segments != 1, "at least two segments, or 0 for known");
  const std::vector<Eigen::Index> shared = Shared(first, second);
  if (shared.empty()) {
    return Refuse("comparison", "no coefficient is known to both models",
                  "identify both from data that excite the same motions");
  }
  const Eigen::VectorXd d = first.theta(shared) - second.theta(shared);
  const Eigen::MatrixXd Sigma1 = first.covariance(shared, shared);
  const Eigen::MatrixXd Sigma2 = second.covariance(shared, shared);
  const Eigen::VectorXd errors = (Sigma1 + Sigma2).diagonal().cwiseSqrt();
  if (!(errors.minCoeff() > 0.0) || !d.allFinite()) {
    return Refuse("comparison", "a coefficient known to both models has no positive variance",
                  "compare models that were identified with bounds");
  }

  const Eigen::MatrixXd inverse_errors = errors.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inverse_errors * (Sigma1 + Sigma2) *
                                                              inverse_errors);
  const Eigen::VectorXd& values = solver.eigenvalues();  // ascending
  const Eigen::Index rank =
      (values.array() > kSmallestEigenvalue * values[values.size() - 1]).count();
  const Eigen::MatrixXd whitening = solver.eigenvectors().rightCols(rank) *
                                    values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::VectorXd scaled = d.cwiseQuotient(errors);
  const Eigen::VectorXd whitened = whitening.transpose() * scaled;

  WaldTest test;
  test.statistic = whitened.squaredNorm();
  test.degrees_of_freedom = static_cast<std::size_t>(rank);
  const double q = static_cast<double>(rank);
  const Eigen::MatrixXd root = inverse_errors * whitening;
  const double shares = Share(root.transpose() * Sigma1 * root, first.segments) +
                        Share(root.transpose() * Sigma2 * root, second.segments);
  const double nu = shares > 0.0 ? (q + q * q) / shares : kInfinity;
  test.segment_degrees_of_freedom = nu;
  if (nu < q + 1.0) {
    return Refuse("comparison",
                  "segments count for " + std::to_string(static_cast<int>(nu)) +
                      " degrees of freedom, and more than " + std::to_string(rank) +
                      " are needed to compare as many coefficients",
                  "record more segments, or compare fewer coefficients");
  }
  test.p_value = JointPValue(test.statistic, q, nu);

  std::vector<Eigen::Index> order(shared.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(scaled[a]) > std::abs(scaled[b]);
  });
  for (const Eigen::Index i : order) {
    const double first_share = Sigma1(i, i) / std::pow(errors[i], 2);
    test.differences.push_back({static_cast<std::size_t>(shared[static_cast<std::size_t>(i)]), d[i],
                                errors[i],
                                SinglePValue(scaled[i], WelchDegrees(first_share, first, second))});
  }
  const Eigen::VectorXd direction = whitening * whitened;
  test.combination = direction(order);
  if (test.combination.norm() > 0.0) test.combination.normalize();
  return test;
}

}  // namespace telltale
