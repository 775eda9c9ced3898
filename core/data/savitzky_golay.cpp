#include "telltale/core/data/savitzky_golay.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

struct Vandermonde {
  Eigen::MatrixXd value;
  Eigen::MatrixXd slope;
};

// Columns s^p and d(s^p)/dj with s = (j - half_width) / half_width in [-1, 1], which keeps the
// columns of like size.
Vandermonde BuildVandermonde(std::size_t half_width, std::size_t degree) {
  const auto rows = static_cast<Eigen::Index>(2 * half_width + 1);
  const auto columns = static_cast<Eigen::Index>(degree + 1);
  const auto scale = static_cast<double>(half_width);
  Vandermonde v{Eigen::MatrixXd::Ones(rows, columns), Eigen::MatrixXd::Zero(rows, columns)};
  const Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(rows, -1.0, 1.0);
  for (Eigen::Index p = 1; p < columns; ++p) {
    v.value.col(p) = v.value.col(p - 1).cwiseProduct(s);
    v.slope.col(p) = v.value.col(p - 1) * (static_cast<double>(p) / scale);
  }
  return v;
}

// Sum_j d_j x_j with x_j = x_0 + increments before j: the increment i enters with all d_j, j > i.
Eigen::MatrixXd OnIncrements(const Eigen::MatrixXd& slope) {
  Eigen::MatrixXd increment(slope.rows(), slope.cols() - 1);
  Eigen::VectorXd running = Eigen::VectorXd::Zero(slope.rows());
  for (Eigen::Index i = 0; i < increment.cols(); ++i) {
    running -= slope.col(i);
    increment.col(i) = running;
  }
  return increment;
}

}  // namespace

SavitzkyGolay::SavitzkyGolay(std::size_t half_width, std::size_t degree) : half_width_(half_width) {
  Require(half_width >= 1, "half_width >= 1");
  Require(degree < 2 * half_width + 1, "degree < 2 half_width + 1");
  const Vandermonde v = BuildVandermonde(half_width, degree);
  const Eigen::MatrixXd fit = v.value.completeOrthogonalDecomposition().pseudoInverse();
  value_ = v.value * fit;
  slope_ = v.slope * fit;
  increment_ = OnIncrements(slope_);
}

std::size_t SavitzkyGolay::WindowStart(std::size_t row, std::size_t length) const {
  Require(length >= WindowLength(), "a series at least as long as the filter's window");
  const std::size_t centred = row > half_width_ ? row - half_width_ : 0;
  return std::min(centred, length - WindowLength());
}

std::vector<double> SavitzkyGolay::Smooth(std::span<const double> series) const {
  return Apply(value_, series, series.size());
}

std::vector<double> SavitzkyGolay::Slope(std::span<const double> series) const {
  return Apply(slope_, series, series.size());
}

std::vector<double> SavitzkyGolay::SlopeOfIncrements(std::span<const double> increments) const {
  return Apply(increment_, increments, increments.size() + 1);
}

std::vector<double> SavitzkyGolay::Apply(const Eigen::MatrixXd& weights,
                                         std::span<const double> series, std::size_t rows) const {
  std::vector<double> filtered(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t start = WindowStart(row, rows);
    const Eigen::Map<const Eigen::RowVectorXd> window(series.data() + start, weights.cols());
    filtered[row] = weights.row(Index(row - start)).dot(window);
  }
  return filtered;
}

}  // namespace telltale
