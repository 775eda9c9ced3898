#include "telltale/core/estimation/output_error/separability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/near_dependency.hpp"

namespace telltale {
namespace {

constexpr double kRounding = 1e-10;
// An unknown belongs to a direction when its component, by its own scale, exceeds this share of the
// largest one.
constexpr double kNamedComponent = 0.1;

/// Columns that span the same space, each with a pivot where all others are zero.
Eigen::MatrixXd Echelon(Eigen::MatrixXd basis) {
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    Eigen::Index pivot = 0;
    Eigen::Index column = 0;
    basis.rightCols(basis.cols() - k).cwiseAbs().maxCoeff(&pivot, &column);
    basis.col(k).swap(basis.col(k + column));
    basis.col(k) /= basis(pivot, k);
    for (Eigen::Index j = 0; j < basis.cols(); ++j) {
      if (j == k) continue;
      const double share = basis(pivot, j);
      basis.col(j) -= share * basis.col(k);
      basis(pivot, j) = 0.0;
    }
  }
  return basis;
}

InseparableDirection Describe(const Eigen::VectorXd& scaled, const Eigen::VectorXd& scale,
                              double condition_index) {
  InseparableDirection direction;
  direction.condition_index = condition_index;
  const double strongest = scaled.cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < scaled.size(); ++j) {
    if (std::abs(scaled[j]) > kNamedComponent * strongest) {
      direction.unknowns.push_back(static_cast<std::size_t>(j));
    }
  }
  std::stable_sort(direction.unknowns.begin(), direction.unknowns.end(),
                   [&](std::size_t a, std::size_t b) {
                     return std::abs(scaled[static_cast<Eigen::Index>(a)]) >
                            std::abs(scaled[static_cast<Eigen::Index>(b)]);
                   });
  direction.change = Eigen::VectorXd::Zero(scaled.size());
  const auto first = static_cast<Eigen::Index>(direction.unknowns.front());
  const double unit = scaled[first] * scale[first];
  for (const std::size_t unknown : direction.unknowns) {
    const auto j = static_cast<Eigen::Index>(unknown);
    direction.change[j] = scaled[j] * scale[j] / unit;
  }
  return direction;
}

InseparableDirection WithoutInformation(Eigen::Index unknown, Eigen::Index count) {
  return {{static_cast<std::size_t>(unknown)},
          Eigen::VectorXd::Unit(count, unknown),
          std::numeric_limits<double>::infinity()};
}

}  // namespace

Separability Separate(const Eigen::MatrixXd& information, const Eigen::VectorXd& raw,
                      double condition_index_limit) {
  Require(information.allFinite() && information.rows() == information.cols(),
          "a finite square information matrix");
  Require(condition_index_limit > 1.0, "a condition index limit above one");
  const Eigen::Index P = information.rows();
  Separability result{
      Eigen::MatrixXd::Zero(P, 0), std::vector<bool>(static_cast<std::size_t>(P), false), {}};
  std::vector<Eigen::Index> informed;
  for (Eigen::Index j = 0; j < P; ++j) {
    if (information(j, j) > kRounding * raw[j]) {
      informed.push_back(j);
    } else {
      result.directions.push_back(WithoutInformation(j, P));
    }
  }
  if (informed.empty()) return result;
  const Eigen::VectorXd scale = information.diagonal()(informed).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = Scaled(information(informed, informed), scale);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const double largest = eigen.eigenvalues().maxCoeff();
  const Eigen::VectorXd lambda =
      eigen.eigenvalues().cwiseMax(largest * std::numeric_limits<double>::epsilon());
  const double least = largest / (condition_index_limit * condition_index_limit);
  const Eigen::Index null = (lambda.array() < least).count();  // the eigenvalues ascend
  const Eigen::Index determined = lambda.size() - null;
  const Eigen::MatrixXd& V = eigen.eigenvectors();
  result.root = Eigen::MatrixXd::Zero(P, determined);
  result.root(informed, Eigen::all) =
      scale.asDiagonal() * V.rightCols(determined) *
      lambda.tail(determined).cwiseSqrt().cwiseInverse().asDiagonal();

  const Eigen::MatrixXd shares = V.cwiseAbs2() * lambda.cwiseInverse().asDiagonal();
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(P);
  for (std::size_t i = 0; i < informed.size(); ++i) {
    const auto row = shares.row(static_cast<Eigen::Index>(i));
    result.separable[static_cast<std::size_t>(informed[i])] =
        row.head(null).sum() <= kDependencyVarianceShare * row.sum();
    whole[informed[i]] = scale[static_cast<Eigen::Index>(i)];
  }
  const Eigen::MatrixXd combinations = Echelon(V.leftCols(null));
  for (Eigen::Index k = 0; k < null; ++k) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(P);
    direction(informed) = combinations.col(k);
    const double information_along =
        combinations.col(k).dot(scaled * combinations.col(k)) / combinations.col(k).squaredNorm();
    const double floor = largest * std::numeric_limits<double>::epsilon();
    result.directions.push_back(
        Describe(direction, whole, std::sqrt(largest / std::max(information_along, floor))));
  }
  return result;
}

}  // namespace telltale
