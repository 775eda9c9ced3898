#include "estimation/triangular_factor.hpp"

#include <gtest/gtest.h>

#include "contract.hpp"

namespace telltale {
namespace {

/// Laws of a QR factorisation, over sizes around the block size of 240 rows.
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

TEST(Triangularise, RequiresMatchingRows) {
  EXPECT_THROW(Triangularise(Eigen::MatrixXd::Zero(5, 2), Eigen::VectorXd::Zero(4)),
               ContractViolation);
}

}  // namespace
}  // namespace telltale
