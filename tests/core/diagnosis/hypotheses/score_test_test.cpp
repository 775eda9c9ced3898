#include "telltale/core/diagnosis/hypotheses/score_test.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kScoreRows = 3;
constexpr Eigen::Index kScoreWindows = 20;

/// Sensitivities that a test chooses, by a metric of unit errors.
struct Linearised {
  Linearised(const Effect& effect, const std::vector<Eigen::MatrixXd>& columns,
             const Eigen::MatrixXd& errors)
      : parameter_refs(EffectParameterRefsOf(std::vector<const Effect*>{&effect})),
        recording(testing::SensitivityOfErrors(errors, 0, std::ssize(columns))) {
    for (Eigen::Index j = 0; j < std::ssize(columns); ++j) {
      recording.by_effect_parameter.col(j) = columns[static_cast<std::size_t>(j)].reshaped();
    }
  }

  std::vector<EffectParameterRef> parameter_refs;
  Sensitivity recording;
  ResidualMetric metric{testing::UnitBaseline(kScoreRows, 0, recording.by_effect_parameter.cols()),
                        recording, EveryWindow(recording), false};
};

TEST(ScoreTest, IsTheLogLikelihoodRatioOfALinearStep) {
  const testing::InertEffect effect(
      "two", {{"first", "N", 2.0, -200.0, 200.0}, {"second", "m", 0.5, -50.0, 50.0}});
  const Eigen::MatrixXd a = testing::Pattern(kScoreRows, kScoreWindows, 0.7);
  const Eigen::MatrixXd b = testing::Pattern(kScoreRows, kScoreWindows, 1.9);
  const Eigen::MatrixXd errors =
      -1.2 * a + 0.4 * b + 0.5 * testing::Pattern(kScoreRows, kScoreWindows, 2.3);
  const Linearised problem(effect, {a, b}, errors);

  Eigen::MatrixXd columns(errors.size(), 2);
  columns << a.reshaped(), b.reshaped();
  const Eigen::Vector2d gradient = columns.transpose() * errors.reshaped();
  // The minimum of n ln(square) + prior: the prior N(0, 4 I) counts by square / n.
  constexpr double kScoreObservations = 0.5 * static_cast<double>(kScoreWindows);
  double square = errors.squaredNorm();
  Eigen::Vector2d sizes;
  for (int round = 0; round < 50; ++round) {
    const Eigen::Matrix2d information =
        columns.transpose() * columns +
        0.25 * square / kScoreObservations * Eigen::Matrix2d::Identity();
    sizes = -information.ldlt().solve(gradient);
    square = (errors.reshaped() + columns * sizes).squaredNorm();
  }
  const double expected = kScoreObservations * std::log(square / errors.squaredNorm());
  EXPECT_NEAR(ScoreTest(effect, problem.metric, errors, problem.recording, problem.parameter_refs),
              expected, 1e-4);

  const auto starts =
      StartsOf(effect, problem.metric, errors, problem.recording, problem.parameter_refs);
  ASSERT_EQ(starts.size(), 1U);
  EXPECT_NEAR(starts[0][0], 2.0 * sizes[0], 1e-4);
  EXPECT_NEAR(starts[0][1], 0.5 * sizes[1], 1e-4);
}

TEST(ScoreTest, IsZeroForAnEffectOrthogonalToTheErrors) {
  const testing::InertEffect effect("one", {{"size", "1", 1.0, -10.0, 10.0}});
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(kScoreRows, kScoreWindows);
  Eigen::MatrixXd column = errors;
  errors.row(0).setOnes();
  column.row(1).setOnes();
  const Linearised problem(effect, {column}, errors);
  EXPECT_DOUBLE_EQ(
      ScoreTest(effect, problem.metric, errors, problem.recording, problem.parameter_refs), 0.0);
}

TEST(StartsOf, HoldBothSignsOfTheTypicalSizeWhereTheRangeHasThem) {
  const Eigen::MatrixXd column = 10.0 * testing::Pattern(kScoreRows, kScoreWindows, 0.7);
  const Eigen::MatrixXd errors = -3.0 * column;
  const testing::InertEffect both("both", {{"size", "1", 0.5, -10.0, 10.0}});
  const Linearised of_both(both, {column}, errors);
  const auto starts =
      StartsOf(both, of_both.metric, errors, of_both.recording, of_both.parameter_refs);
  ASSERT_EQ(starts.size(), 3U);
  EXPECT_NEAR(starts[0][0], 1.5, 0.1);
  EXPECT_EQ(starts[1][0], 0.5);
  EXPECT_EQ(starts[2][0], -0.5);

  const testing::InertEffect positive("positive", {{"size", "1", 0.5, 0.0, 10.0}});
  const Linearised of_positive(positive, {column}, errors);
  EXPECT_EQ(StartsOf(positive, of_positive.metric, errors, of_positive.recording,
                     of_positive.parameter_refs)
                .size(),
            2U);
}

// Its typical size moves the errors by less than three sigmas: it may be larger.
TEST(StartsOf, LieBeyondTheThresholdOfAnEffectThatHides) {
  const Eigen::MatrixXd pattern = testing::Pattern(kScoreRows, kScoreWindows, 0.7);
  const testing::InertEffect positive("positive", {{"size", "1", 0.5, 0.0, 10.0}});
  const testing::InertEffect of_both_signs("both", {{"size", "1", 0.5, -10.0, 10.0}});
  const Linearised hidden(positive, {0.1 * pattern}, pattern);
  ASSERT_LT(hidden.metric.Sigmas(0.1 * pattern.reshaped()), 3.0);
  EXPECT_EQ(
      StartsOf(positive, hidden.metric, pattern, hidden.recording, hidden.parameter_refs).back()[0],
      2.5 * 0.5);
  EXPECT_TRUE(
      HidesBelowThreshold(positive, hidden.metric, hidden.recording, hidden.parameter_refs));

  const Linearised seen(positive, {10.0 * pattern}, pattern);
  EXPECT_FALSE(HidesBelowThreshold(positive, seen.metric, seen.recording, seen.parameter_refs));
  const Linearised two(of_both_signs, {0.1 * pattern}, pattern);
  EXPECT_FALSE(HidesBelowThreshold(of_both_signs, two.metric, two.recording, two.parameter_refs));
}

TEST(StartsOf, KeepShapesAtTheirPriorMeans) {
  const testing::InertEffect effect(
      "shaped", {{"size", "1", 1.0, -10.0, 10.0}, {"shape", "1", 0.25, 0.5, 1.5, true, 1.1}});
  const Eigen::MatrixXd column = testing::Pattern(kScoreRows, kScoreWindows, 0.7);
  const Linearised problem(effect, {column}, -2.0 * column);
  for (const Eigen::VectorXd& start : StartsOf(effect, problem.metric, problem.recording.errors,
                                               problem.recording, problem.parameter_refs)) {
    EXPECT_EQ(start[1], 1.1);
  }
}

TEST(StartsOf, StayWithinTheRange) {
  const testing::InertEffect effect("narrow", {{"size", "1", 1.0, -2.0, 2.0}});
  const Eigen::MatrixXd column = testing::Pattern(kScoreRows, kScoreWindows, 0.7);
  const Linearised problem(effect, {column}, -7.0 * column);
  EXPECT_EQ(StartsOf(effect, problem.metric, problem.recording.errors, problem.recording,
                     problem.parameter_refs)[0][0],
            2.0);
}

}  // namespace
}  // namespace telltale
