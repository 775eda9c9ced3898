#include "telltale/core/uncertainty/whitening.hpp"

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

constexpr double kSmallestVariance = 1e-14;

}  // namespace

Whitening::Whitening(const Eigen::MatrixXd& covariance, const std::vector<Block>& blocks)
    : map(Eigen::MatrixXd::Zero(covariance.rows(), covariance.cols())), inverse(map) {
  const Eigen::VectorXd sizes = covariance.diagonal().cwiseMax(kSmallestVariance).cwiseSqrt();
  const Eigen::MatrixXd correlation = Scaled(covariance, sizes.cwiseInverse());
  for (const auto& [begin, size] : blocks) {
    const Eigen::MatrixXd within = correlation.block(begin, begin, size, size);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(within);
    const Eigen::VectorXd lengths = axes.eigenvalues().cwiseMax(kSmallestVariance).cwiseSqrt();
    const auto of_block = sizes.segment(begin, size);
    map.block(begin, begin, size, size) =
        of_block.asDiagonal() * axes.eigenvectors() * lengths.asDiagonal();
    inverse.block(begin, begin, size, size) = lengths.cwiseInverse().asDiagonal() *
                                              axes.eigenvectors().transpose() *
                                              of_block.cwiseInverse().asDiagonal();
  }
}

Eigen::MatrixXd Whitening::Of(const Eigen::MatrixXd& covariance) const {
  return Mapped(inverse, covariance);
}

}  // namespace telltale
