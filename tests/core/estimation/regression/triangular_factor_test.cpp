#include "telltale/core/estimation/regression/triangular_factor.hpp"

#include <gtest/gtest.h>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

/// Properties of a QR factorisation, over sizes around the block size of 240 rows.
TEST(Triangularise, KeepsGramScoreAndResidual) {
  for (const Eigen::Index rows : {14, 239, 240, 241, 1000}) {
    std::srand(static_cast<unsigned>(rows));
    const Eigen::MatrixXd phi = Eigen::MatrixXd::Random(rows, 7);
    const Eigen::VectorXd y = Eigen::VectorXd::Random(rows);
    const TriangularFactor factor = Triangularise(phi, y);
    EXPECT_TRUE((factor.R.transpose() * factor.R).isApprox(phi.transpose() * phi, 1e-12));
    EXPECT_TRUE((factor.R.transpose() * factor.z).isApprox(phi.transpose() * y, 1e-11));
    EXPECT_NEAR(factor.z.squaredNorm() + factor.rho * factor.rho, y.squaredNorm(), 1e-10);
    EXPECT_TRUE(factor.R.isUpperTriangular());
    EXPECT_EQ(factor.rows, rows);
  }
}

/// The same for each of several y; the third lies in the span of Phi and the other two.
TEST(TriangulariseAll, KeepsScoreAndResidualOfEach) {
  std::srand(5);
  const Eigen::MatrixXd phi = Eigen::MatrixXd::Random(700, 7);
  Eigen::MatrixXd Y = Eigen::MatrixXd::Random(700, 3);
  Y.col(2) = Y.col(0) - 2.0 * Y.col(1) + phi.col(3);
  const auto factors = TriangulariseAll(phi, Y);
  ASSERT_EQ(factors.size(), 3u);
  for (Eigen::Index j = 0; j < 3; ++j) {
    const TriangularFactor& factor = factors[static_cast<std::size_t>(j)];
    EXPECT_TRUE((factor.R.transpose() * factor.R).isApprox(phi.transpose() * phi, 1e-12));
    EXPECT_TRUE((factor.R.transpose() * factor.z).isApprox(phi.transpose() * Y.col(j), 1e-11));
    EXPECT_NEAR(factor.z.squaredNorm() + factor.rho * factor.rho, Y.col(j).squaredNorm(), 1e-9);
    EXPECT_EQ(factor.rows, 700);
  }
}

TEST(Triangularise, RequiresMatchingRows) {
  EXPECT_THROW(Triangularise(Eigen::MatrixXd::Zero(5, 2), Eigen::VectorXd::Zero(4)),
               ContractViolation);
}

}  // namespace
}  // namespace telltale
