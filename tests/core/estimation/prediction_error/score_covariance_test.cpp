#include "telltale/core/estimation/prediction_error/score_covariance.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "support/random_vectors.hpp"
#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/uncertainty/wald.hpp"

namespace telltale {
namespace {

constexpr int kBlocks = 60;
constexpr int kReplicates = 200;
// The first parameters stand in few blocks: those of a manoeuvre that a recording has once or
// twice.
constexpr Eigen::Index kRare = 4;
constexpr int kBlocksOfRare = 6;

// Information of a block: a sum of random squares, larger in some blocks than in others.
Eigen::MatrixXd InformationOf(int block, WhiteSource& white) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
  const double scale = block % 3 == 0 ? 3.0 : 1.0;
  for (int i = 0; i < 40; ++i) {
    FossenVector slope = DrawnVector(white);
    if (block >= kBlocksOfRare) slope.head<kRare>() *= 0.05;
    information += scale * slope * slope.transpose();
  }
  return information;
}

// A fit whose scores have the covariance of the information, but for `scatter`, at its estimate;
// the truth is zero.
struct LinearFit {
  PredictionErrorFit fit;
  FossenVector estimate;
};

LinearFit DrawFit(const std::vector<Eigen::MatrixXd>& informations, std::uint64_t seed,
                  const FossenVector& scatter = FossenVector::Ones()) {
  WhiteSource white(seed, 1);
  LinearFit drawn;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
  FossenVector score = FossenVector::Zero();
  for (const Eigen::MatrixXd& information : informations) {
    const FossenVector expected = information.llt().matrixL() * DrawnVector(white);
    const FossenVector of_block = scatter.cwiseProduct(expected);
    drawn.fit.blocks.push_back({information, of_block});
    sum += information;
    score += of_block;
  }
  drawn.estimate = sum.llt().solve(score);
  for (ScoreBlock& block : drawn.fit.blocks) {
    block.score -= block.information * drawn.estimate;
  }
  drawn.fit.information = drawn.fit.slope = drawn.fit.data_information = sum;
  return drawn;
}

class ScoreCovariance : public ::testing::Test {
 protected:
  void SetUp() override {
    WhiteSource white(7, 0);
    for (int b = 0; b < kBlocks; ++b) informations_.push_back(InformationOf(b, white));
  }

  std::vector<Eigen::MatrixXd> informations_;
};

TEST_F(ScoreCovariance, HoldsEveryParameterAsOftenAsItSays) {
  FossenVector held = FossenVector::Zero();
  for (int i = 0; i < kReplicates; ++i) {
    const LinearFit drawn = DrawFit(informations_, static_cast<std::uint64_t>(i));
    const RobustCovariance bounds = CovarianceOf(drawn.fit, 0.95);
    const FossenVector half = 1.959964 * bounds.ForSingles().diagonal().cwiseSqrt();
    held += (drawn.estimate.cwiseAbs().array() <= half.array()).cast<double>().matrix();
  }
  held /= kReplicates;
  // One share of 200 has a standard error of 1.5 points; three and a half of those for the worst of
  // 27, and two tenths of that for their mean.
  EXPECT_NEAR(held.mean(), 0.95, 0.015);
  EXPECT_GT(held.minCoeff(), 0.895);
}

// With one scatter for all scores the bounds of these four hold 88 % of the time.
TEST_F(ScoreCovariance, HoldsWhereTheScoresOfFewParametersScatterMore) {
  const std::vector<Eigen::MatrixXd> half(informations_.begin(),
                                          informations_.begin() + kBlocks / 2);
  FossenVector scatter = FossenVector::Ones();
  scatter.tail<4>().setConstant(3.0);
  constexpr int kManyReplicates = 500;
  double held = 0.0;
  for (int i = 0; i < kManyReplicates; ++i) {
    const LinearFit drawn = DrawFit(half, static_cast<std::uint64_t>(i), scatter);
    const RobustCovariance bounds = CovarianceOf(drawn.fit, 0.95);
    const FossenVector half_width = 1.959964 * bounds.ForSingles().diagonal().cwiseSqrt();
    held +=
        (drawn.estimate.cwiseAbs().array() <= half_width.array()).tail<4>().cast<double>().sum();
  }
  // A share of 500 has a standard error of 1 point, four of them together of 0.5 to 1.
  EXPECT_GT(held / (4.0 * kManyReplicates), 0.925);
}

// Two directions are known far better than the parameters in them, of which some stand in few
// blocks. With a factor for each parameter the truth of all together holds 83 % of the time.
TEST_F(ScoreCovariance, HoldsAllTogetherWhereDirectionsAreKnownBest) {
  for (Eigen::MatrixXd& information : informations_) {
    FossenVector known = FossenVector::Zero();
    known.head<kRare + 2>().setConstant(100.0);
    FossenVector also_known = FossenVector::Zero();
    also_known.tail<6>() << 100.0, -100.0, 100.0, -100.0, 100.0, -100.0;
    information += known * known.transpose() + also_known * also_known.transpose();
  }
  int held = 0;
  for (int i = 0; i < kReplicates; ++i) {
    const LinearFit drawn = DrawFit(informations_, static_cast<std::uint64_t>(i));
    const Estimates estimated{drawn.estimate, CovarianceOf(drawn.fit, 0.95).covariance,
                              EquivalentBlocks(kBlocks)};
    const Estimates truth{FossenVector::Zero(),
                          Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters), 0};
    const auto test = TestEquality(estimated, truth);
    ASSERT_TRUE(test.has_value());
    if (test->p_value >= 0.05) ++held;
  }
  // A share of 200 has a standard error of 1.5 points; both the widening and the law allow for few
  // blocks.
  EXPECT_GE(held, 0.91 * kReplicates);
}

TEST_F(ScoreCovariance, HasFewDegreesOfFreedomWhereFewBlocksInform) {
  const LinearFit drawn = DrawFit(informations_, 1);
  const RobustCovariance bounds = CovarianceOf(drawn.fit, 0.95);
  const double equivalent = static_cast<double>(EquivalentBlocks(kBlocks));
  EXPECT_LT(bounds.degrees_of_freedom.head<kRare>().maxCoeff(),
            equivalent * kBlocksOfRare / kBlocks);
  EXPECT_GT(bounds.degrees_of_freedom.tail<19>().minCoeff(), 0.5 * equivalent);
}

TEST(EquivalentBlocks, AreMoreThanTheBlocksAndNoneOfNone) {
  EXPECT_EQ(EquivalentBlocks(0), 0U);
  // (60 + 29)^2 / 60
  EXPECT_EQ(EquivalentBlocks(60), 132U);
}

}  // namespace
}  // namespace telltale
