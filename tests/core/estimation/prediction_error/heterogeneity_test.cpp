#include "telltale/core/estimation/prediction_error/heterogeneity.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "support/random_vectors.hpp"
#include "telltale/core/base/gauss_markov.hpp"

namespace telltale {
namespace {

constexpr std::size_t kRecordings = 5;
constexpr std::size_t kBlocksEach = 16;
constexpr Eigen::Index kOdd = 3;

FossenPrior Unbounded() {
  FossenPrior prior;
  prior.least.setConstant(-std::numeric_limits<double>::infinity());
  prior.greatest.setConstant(std::numeric_limits<double>::infinity());
  prior.standard_deviation.setConstant(std::numeric_limits<double>::infinity());
  return prior;
}

// Least squares over recordings of a boat whose parameters are zero, the last recording's `odd` in
// one of them. Scores have the sign of the filter's: the estimate is against them.
struct PooledFit {
  PredictionErrorFit fit;
  FossenVector without_last;
};

PooledFit DrawPooledFit(double odd, std::uint64_t seed) {
  WhiteSource white(seed, 1);
  FossenVector truth = FossenVector::Zero();
  PooledFit drawn;
  drawn.fit.recordings.resize(kRecordings);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
  FossenVector score = FossenVector::Zero();
  for (std::size_t r = 0; r < kRecordings; ++r) {
    if (r + 1 == kRecordings) {
      drawn.without_last = -sum.llt().solve(score);
      truth[kOdd] = odd;
    }
    for (std::size_t b = 0; b < kBlocksEach; ++b) {
      Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
      for (int i = 0; i < 40; ++i) {
        const FossenVector slope = DrawnVector(white);
        information += slope * slope.transpose();
      }
      const FossenVector of_block = information.llt().matrixL() * DrawnVector(white);
      drawn.fit.blocks.push_back({information, of_block - information * truth});
      drawn.fit.recordings[r].information += information;
      drawn.fit.recordings[r].score += drawn.fit.blocks.back().score;
    }
    sum += drawn.fit.recordings[r].information;
    score += drawn.fit.recordings[r].score;
  }
  drawn.fit.parameters = -sum.llt().solve(score);
  for (auto* blocks : {&drawn.fit.blocks, &drawn.fit.recordings}) {
    for (ScoreBlock& block : *blocks) block.score += block.information * drawn.fit.parameters;
  }
  drawn.fit.information = drawn.fit.slope = drawn.fit.data_information = sum;
  return drawn;
}

TEST(Heterogeneity, OfOneBoatIsAsOftenBeyondItsLevelAsItSays) {
  constexpr int kReplicates = 200;
  double beyond = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kReplicates; ++i) {
    const auto all =
        HeterogeneityOf(DrawPooledFit(0.0, static_cast<std::uint64_t>(i)).fit, Unbounded());
    for (const RecordingDifference& one : all.recordings) beyond += one.p_value < 0.1 ? 1.0 : 0.0;
    squares += all.birge_ratio * all.birge_ratio;
  }
  // A share of 1000 has a standard error of 0.01, three of those and Bonferroni's inequality; the
  // mean of 200 squares over 130 directions one of 0.01.
  EXPECT_NEAR(beyond / (kReplicates * kRecordings), 0.1, 0.035);
  EXPECT_NEAR(squares / kReplicates, 1.0, 0.05);
}

TEST(Heterogeneity, NamesTheRecordingOfAnotherBoatAndWhatTheOthersSay) {
  // The others know a parameter to about 1 / sqrt(4 * 16 * 40) = 0.02, the last to 0.04: it is off
  // by 6.7 standard errors of the difference.
  const PooledFit drawn = DrawPooledFit(0.3, 1);
  const auto all = HeterogeneityOf(drawn.fit, Unbounded());
  ASSERT_EQ(all.recordings.size(), kRecordings);
  EXPECT_LT(all.recordings.back().p_value, 0.001);
  EXPECT_EQ(At(all.recordings.back().parameter), kOdd);
  // Least squares are linear, so that the first order is all.
  EXPECT_NEAR(all.recordings.back().without, drawn.without_last[kOdd], 1e-9);
  EXPECT_LT(HeterogeneityOf(DrawPooledFit(0.0, 1).fit, Unbounded()).birge_ratio, all.birge_ratio);
}

TEST(Heterogeneity, OfOneRecordingIsNone) {
  PredictionErrorFit one = DrawPooledFit(0.0, 1).fit;
  one.recordings.resize(1);
  EXPECT_TRUE(HeterogeneityOf(one, Unbounded()).recordings.empty());
  EXPECT_EQ(HeterogeneityOf(one, Unbounded()).birge_ratio, 0.0);
}

}  // namespace
}  // namespace telltale
