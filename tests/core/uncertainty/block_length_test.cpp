#include "telltale/core/uncertainty/block_length.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

Eigen::VectorXd Autoregression(double rho, Eigen::Index rows, std::uint64_t seed) {
  RandomEngine engine(seed);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::VectorXd series(rows);
  double value = normal(engine) / std::sqrt(1.0 - rho * rho);
  for (double& element : series) {
    element = value;
    value = rho * value + normal(engine);
  }
  return series.array() - series.mean();
}

/// Politis and White (2004) with D = 4/3 g^2: for AR(1) sum |k| R(k) / sum R(k) is
/// 2 rho / (1 - rho^2).
double LengthForAutoregression(double rho, double rows) {
  return std::cbrt(1.5 * std::pow(2.0 * rho / (1.0 - rho * rho), 2) * rows);
}

double MeanLength(double rho, Eigen::Index rows) {
  double sum = 0.0;
  constexpr std::uint64_t kRepeats = 40;
  for (std::uint64_t seed = 1; seed <= kRepeats; ++seed) {
    const std::vector<RowRange> whole = {{0, static_cast<std::size_t>(rows)}};
    sum += static_cast<double>(BlockLength(Autoregression(rho, rows, seed), whole));
  }
  return sum / static_cast<double>(kRepeats);
}

/// The estimate scatters by some 15 % a series and its median lies a little low, since the window
/// cuts the correlogram short; the mean of 40 series is good to 10 %.
TEST(BlockLength, AgreesWithTheFormulaForAutoregressions) {
  for (const double rho : {0.3, 0.5, 0.8}) {
    const double formula = LengthForAutoregression(rho, 16000.0);
    EXPECT_NEAR(MeanLength(rho, 16000), formula, 0.1 * formula) << "rho " << rho;
  }
}

TEST(BlockLength, GrowsWithTheCubeRootOfTheRows) {
  EXPECT_NEAR(MeanLength(0.5, 16000) / MeanLength(0.5, 2000), 2.0, 0.3);
}

TEST(BlockLength, IsShortForWhiteNoise) {
  EXPECT_LT(MeanLength(0.0, 16000), 5.0);
}

/// Two series count alike, so that the cube of the joint length is the mean of their cubes; a
/// series that never moves says nothing.
TEST(BlockLength, GivesSeriesEqualWeightWhateverTheirUnits) {
  Eigen::MatrixXd both(16000, 3);
  both << Autoregression(0.5, 16000, 3), 1e6 * Autoregression(0.8, 16000, 4),
      Eigen::VectorXd::Zero(16000);
  const std::vector<RowRange> whole = {{0, 16000}};
  const double one = static_cast<double>(BlockLength(both.col(0), whole));
  const double other = static_cast<double>(BlockLength(both.col(1), whole));
  const double mean = std::cbrt(0.5 * (std::pow(one, 3) + std::pow(other, 3)));
  EXPECT_NEAR(static_cast<double>(BlockLength(both, whole)), mean, 1.0);  // lengths are rounded
}

/// Alternating signs from run to run: any product across a border would be negative.
TEST(BlockLength, FormsNoProductAcrossAGap) {
  Eigen::VectorXd series(4000);
  std::vector<RowRange> runs;
  for (std::size_t begin = 0; begin < 4000; begin += 4) {
    runs.push_back({begin, begin + 4});
    series.segment(static_cast<Eigen::Index>(begin), 4).setConstant(begin % 8 == 0 ? 1.0 : -1.0);
  }
  // R(k) / R(0) = 1, 3/4, 1/2, 1/4 and nothing beyond: the last significant lag is 3, the window 6
  // wide and flat up to 3. G = 2 (3/4 + 2/2 + 3/4) = 5, g = 1 + 2 (3/4 + 1/2 + 1/4) = 4.
  EXPECT_EQ(BlockLength(series, runs),
            static_cast<std::size_t>(std::lround(std::cbrt(1.5 * 25.0 / 16.0 * 4000.0))));
}

TEST(BlockLength, NeverExceedsAThirdOfTheRows) {
  const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(60, -1.0, 1.0);
  EXPECT_LE(BlockLength(ramp, {{0, 60}}), 20u);
  EXPECT_EQ(BlockLength(Eigen::VectorXd::Zero(60), {{0, 60}}), 1u);
}

}  // namespace
}  // namespace telltale
