#include "estimation/triangular_factor.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "contract.hpp"

namespace telltale {
namespace {

// 240 rows of 14 doubles are 27 KB: a block and its triangle fit a first-level data cache.
constexpr Eigen::Index kBlockRows = 240;

}  // namespace

TriangularFactor Triangularise(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                               const Eigen::Ref<const Eigen::VectorXd>& y) {
  Require(phi.rows() == y.size(), "as many rows in Phi as in y");
  const Eigen::Index p = phi.cols();
  const Eigen::Index width = p + 1;
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(width + kBlockRows, width);
  for (Eigen::Index first = 0; first < phi.rows(); first += kBlockRows) {
    const Eigen::Index count = std::min(kBlockRows, phi.rows() - first);
    auto active = stack.topRows(width + count);
    active.block(width, 0, count, p) = phi.middleRows(first, count);
    active.block(width, p, count, 1) = y.segment(first, count);
    Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(active);
    stack.topRows(width).triangularView<Eigen::StrictlyLower>().setZero();
  }
  TriangularFactor factor;
  factor.R = stack.topLeftCorner(p, p);
  factor.z = stack.block(0, p, p, 1);
  factor.rho = std::abs(stack(p, p));
  factor.rows = phi.rows();
  return factor;
}

}  // namespace telltale
