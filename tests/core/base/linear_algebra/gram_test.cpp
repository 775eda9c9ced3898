#include "telltale/core/base/linear_algebra/gram.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(Gram, IsOfTheProductsOfAllPairsOfColumns) {
  const Eigen::MatrixXd A = (Eigen::MatrixXd(3, 2) << 1.0, -2.0, 3.0, 0.5, 0.0, 4.0).finished();
  const Eigen::MatrixXd expected = (Eigen::MatrixXd(2, 2) << 10.0, -0.5, -0.5, 20.25).finished();
  EXPECT_EQ(Gram(A), expected);
}

TEST(Gram, IsSymmetricToTheLastDigit) {
  const Eigen::VectorXd column = Eigen::VectorXd::LinSpaced(300, 1.0, 7.0);
  const Eigen::RowVectorXd row = Eigen::RowVectorXd::LinSpaced(40, 0.3, 3.0);
  const Eigen::MatrixXd A = (column * row).array().sin();
  EXPECT_EQ(Gram(A), Gram(A).transpose());
}

}  // namespace
}  // namespace telltale
