#include "telltale/core/paper/redundant_least_squares.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/uniform_real_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

using Table = std::array<Eigen::VectorXd, 3>;

/// Rows made by the redundant discrete model itself, nu(k+1) = nu(k) + A(k) X. Read as a recursion
/// the printed table is unstable, so every segment is three rows long and starts anywhere.
PreparedDataset DriveRedundant(const Table& X, std::size_t segments,
                               const std::vector<PropellerRegion>& regions) {
  PreparedDataset dataset;
  dataset.sampling_period_s = kYellowfishSamplingPeriodS;
  const auto commands = testing::RandomCommands(segments, regions, 3);
  RandomEngine engine(4);
  boost::random::uniform_real_distribution<double> velocity(-1.0, 1.0);
  for (std::size_t s = 0; s < segments; ++s) {
    std::array<PreparedRow, 3> rows;
    for (PreparedRow& row : rows) {
      row.delta = commands[s];
      row.region = RegionOf(row.delta);
      row.nu = {velocity(engine), velocity(engine), velocity(engine)};
    }
    std::array<double, 3> next{};
    for (const Equation equation : kEquations) {
      Eigen::VectorXd A(X[IndexOf(equation)].size());
      FillRedundantRow(equation, rows[1].nu, rows[0].nu, rows[0].delta,
                       {A.data(), static_cast<std::size_t>(A.size())});
      next[IndexOf(equation)] = ComponentOf(rows[1].nu, equation) + A.dot(X[IndexOf(equation)]);
    }
    rows[2].nu = {next[0], next[1], next[2]};
    const std::size_t begin = dataset.rows.size();
    dataset.rows.insert(dataset.rows.end(), rows.begin(), rows.end());
    dataset.segments.push_back({begin, begin + 3});
    dataset.slices.push_back({begin, begin + 3});
  }
  return dataset;
}

/// Every number of the paper's dynamic table comes back from data made with it.
TEST(EstimateRedundant, RecoversThePublishedDynamicTable) {
  const Table table = YellowfishDynamicTable();
  const auto dataset = DriveRedundant(
      table, 3000, {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF});
  for (const Equation equation : kEquations) {
    const auto X = EstimateRedundant(BuildRedundant(dataset, equation, {}));
    ASSERT_TRUE(X.has_value()) << X.error().reason;
    const Eigen::VectorXd& truth = table[IndexOf(equation)];
    ASSERT_EQ(X->size(), truth.size());
    for (Eigen::Index i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR((*X)[i], truth[i], 1e-8 * std::abs(truth[i])) << Name(equation) << " " << i;
    }
  }
}

TEST(EstimateRedundant, HasThePapersColumnCounts) {
  EXPECT_EQ(RedundantRegressors(Equation::kSurge).size(), 11u);
  EXPECT_EQ(RedundantRegressors(Equation::kSway).size(), 21u);
  EXPECT_EQ(RedundantRegressors(Equation::kYaw).size(), 21u);
}

/// In FF alone the propellers have the same curve, so two of the columns are zero.
TEST(EstimateRedundant, RefusesWhatForwardRowsCannotDetermine) {
  const auto dataset = DriveRedundant(YellowfishDynamicTable(), 3000, {PropellerRegion::kFF});
  EXPECT_TRUE(EstimateRedundant(BuildRedundant(dataset, Equation::kSurge, {})).has_value());
  const auto yaw = EstimateRedundant(BuildRedundant(dataset, Equation::kYaw, {}));
  ASSERT_FALSE(yaw.has_value());
  EXPECT_NE(yaw.error().reason.find("19 of 21"), std::string::npos) << yaw.error().reason;
}

/// Consistent by construction: alpha = 0.7 in all three, h R = -0.05, -0.1, -0.2.
TEST(RecoverAlpha, FindsTheAlphaOfAConsistentSystem) {
  Table X = YellowfishDynamicTable();
  const double alpha = 0.7;
  const std::array<double, 3> hR = {-0.05, -0.1, -0.2};
  const std::array<Eigen::Index, 3> second = {4, 7, 8};
  for (std::size_t j = 0; j < 3; ++j) {
    X[j][0] = alpha + hR[j];
    X[j][second[j]] = -alpha * (1.0 + hR[j]);
  }
  const RedundantAlpha recovered = RecoverAlpha(X);
  EXPECT_NEAR(recovered.alpha, alpha, 1e-6);
  EXPECT_NEAR(recovered.residual, 0.0, 1e-8);
  EXPECT_TRUE(recovered.agree);
}

/// By hand from the printed table: surge (1.8062 -+ sqrt(1.8062^2 - 4 * 0.7725)) / 2 = 1.1107,
/// 0.6955; sway 0.9739, 0.7165; yaw has no real root, 1.9886^2 < 4 * 1.0430.
TEST(RecoverAlpha, ReportsThatThePublishedTableIsInconsistent) {
  const RedundantAlpha recovered = RecoverAlpha(YellowfishDynamicTable());
  EXPECT_NEAR(recovered.roots[0][0].real(), 1.1107, 1e-4);
  EXPECT_NEAR(recovered.roots[0][1].real(), 0.6955, 1e-4);
  EXPECT_NEAR(recovered.roots[1][0].real(), 0.9739, 1e-4);
  EXPECT_NEAR(recovered.roots[1][1].real(), 0.7165, 1e-4);
  EXPECT_GT(std::abs(recovered.roots[2][0].imag()), 0.1);
  EXPECT_FALSE(recovered.agree);
  EXPECT_GT(recovered.residual, 0.005);
  EXPECT_GT(recovered.alpha, 0.0);
  EXPECT_LT(recovered.alpha, 1.0);
}

}  // namespace
}  // namespace telltale
