#include "telltale/core/estimation/regression/triangular_factor.hpp"

#include <algorithm>

#include <Eigen/QR>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

// 240 rows of 14 doubles are 27 KB: a block and its triangle fit a first-level data cache.
constexpr Eigen::Index kBlockRows = 240;

}  // namespace

TriangularFactor Triangularise(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                               const Eigen::Ref<const Eigen::VectorXd>& y) {
  return TriangulariseAll(phi, y).front();
}

std::vector<TriangularFactor> TriangulariseAll(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                                               const Eigen::Ref<const Eigen::MatrixXd>& Y) {
  Require(phi.rows() == Y.rows(), "as many rows in Phi as in y");
  const Eigen::Index p = phi.cols();
  const Eigen::Index width = p + Y.cols();
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(width + kBlockRows, width);
  for (Eigen::Index first = 0; first < phi.rows(); first += kBlockRows) {
    const Eigen::Index count = std::min(kBlockRows, phi.rows() - first);
    auto active = stack.topRows(width + count);
    active.block(width, 0, count, p) = phi.middleRows(first, count);
    active.block(width, p, count, Y.cols()) = Y.middleRows(first, count);
    Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(active);
    stack.topRows(width).triangularView<Eigen::StrictlyLower>().setZero();
  }
  std::vector<TriangularFactor> factors;
  for (Eigen::Index j = 0; j < Y.cols(); ++j) {
    // What Phi leaves of a later y lies along what it leaves of those before, and beside.
    factors.push_back({stack.topLeftCorner(p, p), stack.block(0, p + j, p, 1),
                       stack.col(p + j).segment(p, j + 1).norm(), phi.rows()});
  }
  return factors;
}

}  // namespace telltale
