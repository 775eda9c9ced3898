#include "telltale/core/base/linear_algebra/covariance.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

const Eigen::MatrixXd kV = (Eigen::MatrixXd(2, 2) << 4.0, 1.0, 1.0, 9.0).finished();

TEST(Covariance, OverStandardErrorsIsTheCorrelations) {
  const Eigen::MatrixXd correlation = Scaled(kV, kV.diagonal().cwiseSqrt().cwiseInverse());
  const Eigen::MatrixXd expected =
      (Eigen::MatrixXd(2, 2) << 1.0, 1.0 / 6.0, 1.0 / 6.0, 1.0).finished();
  EXPECT_TRUE(correlation.isApprox(expected, 1e-15));
}

/// Var(a + b) = Var a + Var b + 2 Cov, Var(a - b) = Var a + Var b - 2 Cov; their Cov is Var a - Var
/// b.
TEST(Covariance, IsMappedAsSumAndDifferenceAre) {
  const Eigen::MatrixXd A = (Eigen::MatrixXd(2, 2) << 1.0, 1.0, 1.0, -1.0).finished();
  const Eigen::MatrixXd expected = (Eigen::MatrixXd(2, 2) << 15.0, -5.0, -5.0, 11.0).finished();
  EXPECT_EQ(Mapped(A, kV), expected);
}

TEST(Covariance, IsSymmetricHoweverIllConditioned) {
  const Eigen::MatrixXd A =
      (Eigen::MatrixXd(3, 3) << 1.0, 1e9 / 3.0, 0.1, 0.3, -1e-7, 7e8, 1e8 / 7.0, 0.7, 1.1)
          .finished();
  const Eigen::MatrixXd V =
      (Eigen::MatrixXd(3, 3) << 0.7, 0.1, 1e-9, 0.1, 3e-10, 0.0, 1e-9, 0.0, 1e-8).finished();
  const Eigen::MatrixXd mapped = Mapped(A, V);
  EXPECT_EQ(mapped, mapped.transpose());
}

TEST(Covariance, OfARootIsThatOfItsColumnsTogether) {
  const Eigen::MatrixXd root = (Eigen::MatrixXd(2, 3) << 1.0, 2.0, 0.0, 0.0, 3.0, -1.0).finished();
  const Eigen::MatrixXd expected = (Eigen::MatrixXd(2, 2) << 5.0, 6.0, 6.0, 10.0).finished();
  EXPECT_EQ(OfRoot(root), expected);
}

TEST(Covariance, IsTheInverseOfItsInformation) {
  const Eigen::MatrixXd expected =
      (Eigen::MatrixXd(2, 2) << 9.0, -1.0, -1.0, 4.0).finished() / 35.0;
  EXPECT_TRUE(Inverse(kV).isApprox(expected, 1e-15));
}

}  // namespace
}  // namespace telltale
