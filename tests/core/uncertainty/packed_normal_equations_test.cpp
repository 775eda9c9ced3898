#include "telltale/core/uncertainty/packed_normal_equations.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// Rows [w e] of a small problem.
Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> Rows(Eigen::Index count,
                                                                            Eigen::Index r) {
  RandomEngine engine(5);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(count, r + 1);
  for (double& value : rows.reshaped()) value = normal(engine);
  return rows;
}

class PackedNormal : public ::testing::TestWithParam<std::size_t> {
 protected:
  PackedNormal()
      : r(GetParam()),
        rows(Rows(60, static_cast<Eigen::Index>(r))),
        W(rows.leftCols(rows.cols() - 1)),
        e(rows.rightCols(1)),
        system(PackedLength(r), 0.0) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      AddRow(rows.row(i).data(), r, 1.0, system.data());
  }

  std::size_t r;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows;
  Eigen::MatrixXd W;
  Eigen::VectorXd e;
  std::vector<double> system;
};

TEST_P(PackedNormal, SolvesTheLeastSquaresProblemOfItsRows) {
  const Eigen::VectorXd direct = W.colPivHouseholderQr().solve(e);
  Eigen::VectorXd x(W.cols());
  ASSERT_TRUE(Factorise(r, system.data()));
  Substitute(system.data(), r, x.data());
  EXPECT_TRUE(x.isApprox(direct, 1e-12)) << (x - direct).transpose();
}

TEST_P(PackedNormal, ScoreIsThatAtX) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(W.cols(), -1.0, 2.0);
  const Eigen::VectorXd direct = W.transpose() * (e - W * x);
  Eigen::VectorXd score(W.cols());
  ScoreAt(system.data(), r, x.data(), score.data());
  EXPECT_TRUE(score.isApprox(direct, 1e-12)) << (score - direct).transpose();
}

TEST_P(PackedNormal, SystemsAddUpWithWeights) {
  std::vector<double> sum(PackedLength(r), 0.0);
  AddSystem(system.data(), r, 3.0, sum.data());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) AddRow(rows.row(i).data(), r, -1.0, sum.data());
  for (std::size_t k = 0; k < sum.size(); ++k) EXPECT_NEAR(sum[k], 2.0 * system[k], 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PackedNormal, ::testing::Values(1, 2, 3, 13, 38));

TEST(Factorise, RefusesASingularSystem) {
  for (const double second : {0.0, 1e-12}) {
    std::vector<double> system = {1.0, 0.0, 1.0, second, 1.0};  // diag(1, second), b = (1, 1)
    EXPECT_FALSE(Factorise(2, system.data()));
  }
  std::vector<double> regular = {4.0, 0.0, 8.0, 1.0, 3.0};
  ASSERT_TRUE(Factorise(2, regular.data()));
  double x[2];
  Substitute(regular.data(), 2, x);
  EXPECT_DOUBLE_EQ(x[0], 2.0);
  EXPECT_DOUBLE_EQ(x[1], 3.0);
}

}  // namespace
}  // namespace telltale
