#include "telltale/core/estimation/output_error/separability.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr double kLimit = 1e4;

Eigen::MatrixXd RandomMatrix(Eigen::Index rows, Eigen::Index columns) {
  RandomEngine engine(3);
  boost::random::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(rows, columns);
  for (double& value : matrix.reshaped()) value = normal(engine);
  return matrix;
}

Separability SeparateColumns(const Eigen::MatrixXd& J) {
  const Eigen::MatrixXd information = J.transpose() * J;
  return Separate(information, information.diagonal(), kLimit);
}

TEST(Separate, InvertsASeparableInformation) {
  const Eigen::MatrixXd J = RandomMatrix(50, 6);
  const Separability found = SeparateColumns(J);
  EXPECT_TRUE(found.directions.empty());
  EXPECT_THAT(found.separable, ::testing::Each(true));
  const Eigen::MatrixXd inverse = found.root * found.root.transpose();
  const Eigen::MatrixXd information = J.transpose() * J;
  const Eigen::MatrixXd product = inverse * information;
  EXPECT_LT((product - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-10);
}

/// Column 4 is 2 times column 1 less 3 times column 2: change them so and nothing moves.
TEST(Separate, NamesTheCombinationInTheUnitsOfItsUnknowns) {
  Eigen::MatrixXd J = RandomMatrix(50, 6);
  J.col(4) = 2.0 * J.col(1) - 3.0 * J.col(2);
  const Separability found = SeparateColumns(J);
  ASSERT_EQ(found.directions.size(), 1U);
  const InseparableDirection& direction = found.directions.front();
  EXPECT_THAT(direction.unknowns, UnorderedElementsAre(1, 2, 4));
  EXPECT_LT((J * direction.change).norm(), 1e-6);
  EXPECT_NEAR(direction.change[1] / direction.change[4], -2.0, 1e-6);
  EXPECT_NEAR(direction.change[2] / direction.change[4], 3.0, 1e-6);
  EXPECT_THAT(found.separable, ElementsAre(true, false, false, true, false, true));
  EXPECT_GT(direction.condition_index, kLimit);
}

TEST(Separate, SeparatesTwoCombinations) {
  Eigen::MatrixXd J = RandomMatrix(50, 6);
  J.col(1) = 5.0 * J.col(0);
  J.col(3) = -J.col(2);
  const Separability found = SeparateColumns(J);
  ASSERT_EQ(found.directions.size(), 2U);
  EXPECT_THAT(std::vector({found.directions[0].unknowns, found.directions[1].unknowns}),
              UnorderedElementsAre(UnorderedElementsAre(0, 1), UnorderedElementsAre(2, 3)));
  EXPECT_EQ(found.root.cols(), 4);
}

/// Verdicts do not depend on units: scale columns over twelve orders of magnitude.
TEST(Separate, DoesNotDependOnUnits) {
  Eigen::MatrixXd J = RandomMatrix(50, 5);
  J.col(3) = J.col(0) + J.col(1);
  const Separability before = SeparateColumns(J);
  const Eigen::VectorXd units = (Eigen::VectorXd(5) << 1e-6, 1.0, 1e3, 1e6, 1e-2).finished();
  const Separability after = SeparateColumns(J * units.asDiagonal());
  EXPECT_EQ(before.separable, after.separable);
  ASSERT_EQ(after.directions.size(), 1U);
  EXPECT_THAT(after.directions[0].unknowns, UnorderedElementsAre(0, 1, 3));
}

TEST(Separate, CallsAnUnknownWithoutInformationInseparable) {
  Eigen::MatrixXd J = RandomMatrix(50, 4);
  J.col(2).setZero();
  const Separability found = SeparateColumns(J);
  ASSERT_EQ(found.directions.size(), 1U);
  EXPECT_THAT(found.directions[0].unknowns, ElementsAre(2));
  EXPECT_EQ(found.directions[0].condition_index, std::numeric_limits<double>::infinity());
  EXPECT_THAT(found.separable, ElementsAre(true, true, false, true));
  EXPECT_EQ(found.root.row(2).norm(), 0.0);
}

/// What the raw diagonal says was lost in elimination is not taken for information.
TEST(Separate, TakesRoundingForNothing) {
  const Eigen::MatrixXd information = Eigen::Vector2d(1.0, 1e-13).asDiagonal();
  EXPECT_THAT(Separate(information, Eigen::Vector2d(1.0, 1.0), kLimit).separable,
              ElementsAre(true, false));
}

TEST(Separate, ReturnsADirectionEachWithoutInformation) {
  const Separability found =
      Separate(Eigen::MatrixXd::Zero(3, 3), Eigen::VectorXd::Zero(3), kLimit);
  EXPECT_EQ(found.directions.size(), 3U);
  EXPECT_EQ(found.root.cols(), 0);
}

TEST(Separate, RequiresAFiniteMatrix) {
  const Eigen::MatrixXd information =
      Eigen::MatrixXd::Constant(2, 2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(Separate(information, Eigen::VectorXd::Zero(2), kLimit), ContractViolation);
}

}  // namespace
}  // namespace telltale
