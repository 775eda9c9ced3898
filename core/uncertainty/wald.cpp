#include "telltale/core/uncertainty/wald.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

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
double Share(const Eigen::MatrixXd& whitened, std::size_t clusters) {
  if (clusters == 0) return 0.0;
  return ((whitened * whitened).trace() + std::pow(whitened.trace(), 2)) /
         static_cast<double>(clusters - 1);
}

double JointPValue(double statistic, double q, double nu) {
  if (std::isinf(nu)) return ChiSquaredTail(q, statistic);
  return FisherTail(q, nu - q + 1.0, statistic * (nu - q + 1.0) / (nu * q));
}

/// The two-sided law of one scaled difference, nu by Welch and Satterthwaite.
double SinglePValue(double scaled, double nu) {
  if (std::isinf(nu)) return 2.0 * NormalTail(std::abs(scaled));
  return 2.0 * StudentTail(nu, std::abs(scaled));
}

double WelchDegrees(double first_share, const Estimates& first, const Estimates& second) {
  double reciprocal = 0.0;
  if (first.clusters > 0) {
    reciprocal += std::pow(first_share, 2) / static_cast<double>(first.clusters - 1);
  }
  if (second.clusters > 0) {
    reciprocal += std::pow(1.0 - first_share, 2) / static_cast<double>(second.clusters - 1);
  }
  return reciprocal > 0.0 ? 1.0 / reciprocal : kInfinity;
}

/// Directions that V spans: matrix' (d / errors) has unit covariance.
struct SpannedDirections {
  Eigen::VectorXd errors;  // standard errors of d
  Eigen::MatrixXd matrix;  // coefficients x rank, for d in units of its errors
};

SpannedDirections DirectionsOf(const Eigen::MatrixXd& V) {
  SpannedDirections directions;
  directions.errors = V.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation = Scaled(V, directions.errors.cwiseInverse());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  const Eigen::VectorXd& values = solver.eigenvalues();  // ascending
  const Eigen::Index rank =
      (values.array() > kSmallestEigenvalue * values[values.size() - 1]).count();
  directions.matrix = solver.eigenvectors().rightCols(rank) *
                      values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
  return directions;
}

/// Krishnamoorthy and Yu's degrees of freedom of Sigma1 + Sigma2.
double JointDegrees(const Estimates& first, const Estimates& second,
                    const SpannedDirections& directions) {
  const Eigen::MatrixXd whiten =
      directions.matrix.transpose() * directions.errors.cwiseInverse().asDiagonal();
  const double q = static_cast<double>(whiten.rows());
  const double shares = Share(Mapped(whiten, first.covariance), first.clusters) +
                        Share(Mapped(whiten, second.covariance), second.clusters);
  return shares > 0.0 ? (q + q * q) / shares : kInfinity;
}

Estimates Among(const Estimates& estimates, const std::vector<Eigen::Index>& which) {
  return {estimates.theta(which), estimates.covariance(which, which), estimates.clusters};
}

/// Places in `scaled`, the largest first.
std::vector<Eigen::Index> BySize(const Eigen::VectorXd& scaled) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(scaled.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(scaled[a]) > std::abs(scaled[b]);
  });
  return order;
}

}  // namespace

Result<WaldTest> TestEquality(const Estimates& first, const Estimates& second) {
  const Eigen::Index p = first.theta.size();
  Require(second.theta.size() == p && first.covariance.rows() == p &&
              first.covariance.cols() == p && second.covariance.rows() == p &&
              second.covariance.cols() == p,
          "estimates and covariances of the same coefficients");
  Require(first.clusters != 1 && second.clusters != 1, "at least two segments, or 0 for known");
  const std::vector<Eigen::Index> shared = Shared(first, second);
  if (shared.empty()) {
    return Refuse("comparison", "no coefficient is known to both models",
                  "identify both from data that excite the same motions");
  }
  const Estimates one = Among(first, shared);
  const Estimates other = Among(second, shared);
  const Eigen::VectorXd d = one.theta - other.theta;
  const Eigen::MatrixXd V = one.covariance + other.covariance;
  if (!(V.diagonal().minCoeff() > 0.0) || !d.allFinite()) {
    return Refuse("comparison", "a coefficient known to both models has no positive variance",
                  "compare models that were identified with bounds");
  }

  const SpannedDirections directions = DirectionsOf(V);
  const Eigen::VectorXd scaled = d.cwiseQuotient(directions.errors);
  const Eigen::VectorXd whitened = directions.matrix.transpose() * scaled;
  const double q = static_cast<double>(whitened.size());
  WaldTest test;
  test.statistic = whitened.squaredNorm();
  test.degrees_of_freedom = static_cast<std::size_t>(whitened.size());
  test.covariance_degrees_of_freedom = JointDegrees(one, other, directions);
  if (test.covariance_degrees_of_freedom < q + 1.0) {
    return Refuse("comparison",
                  "segments count for " +
                      std::to_string(static_cast<int>(test.covariance_degrees_of_freedom)) +
                      " degrees of freedom, and more than " +
                      std::to_string(test.degrees_of_freedom) +
                      " are needed to compare as many coefficients",
                  "record more segments, or compare fewer coefficients");
  }
  test.p_value = JointPValue(test.statistic, q, test.covariance_degrees_of_freedom);

  const std::vector<Eigen::Index> order = BySize(scaled);
  for (const Eigen::Index i : order) {
    const double nu = WelchDegrees(one.covariance(i, i) / V(i, i), first, second);
    test.differences.push_back({static_cast<std::size_t>(shared[static_cast<std::size_t>(i)]), d[i],
                                directions.errors[i], SinglePValue(scaled[i], nu)});
  }
  test.combination = Eigen::VectorXd(directions.matrix * whitened)(order);
  if (test.combination.norm() > 0.0) test.combination.normalize();
  return test;
}

}  // namespace telltale
