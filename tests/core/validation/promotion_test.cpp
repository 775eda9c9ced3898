#include "telltale/core/validation/promotion.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Nu kPromotionLimits{4.0, 2.0, 1.0};

/// Errors of the model and of constant velocity: surge, sway, yaw.
FreeRunScores ScoresOf(std::array<double, 3> model, std::array<double, 3> constant_velocity) {
  FreeRunScores scores;
  scores.horizon_s = 5.0;
  scores.windows = 20;
  for (std::size_t i = 0; i < model.size(); ++i) {
    scores.velocity[i].rmse = model[i];
    scores.velocity[i].constant_velocity_rmse = constant_velocity[i];
  }
  return scores;
}

HeldOutScore HeldOut(const FreeRunScores& scores) {
  HeldOutScore score;
  score.training_s = 240.0;
  score.held_out_s = 60.0;
  score.metrics.free_run = {scores};
  return score;
}

const FreeRunScores kSoundScores = ScoresOf({0.1, 0.05, 0.02}, {0.5, 0.2, 0.2});

TEST(Promotion, IsOkWhereNothingSpeaksAgainstTheModel) {
  EXPECT_EQ(PromotionByScores(kSoundScores, kPromotionLimits, std::nullopt).verdict,
            PromotionVerdict::kOk);
  const auto promotion = PromotionByScores(kSoundScores, kPromotionLimits, HeldOut(kSoundScores));
  EXPECT_EQ(promotion.verdict, PromotionVerdict::kOk);
  EXPECT_EQ(promotion.reason, "");
}

TEST(Promotion, IsAnErrorWhereTheModelDiverges) {
  for (const double error : {4.5, kInfinity, std::nan("")}) {
    const auto own = ScoresOf({error, 0.05, 0.02}, {0.5, 0.2, 0.2});
    const auto promotion = PromotionByScores(own, kPromotionLimits, HeldOut(kSoundScores));
    EXPECT_EQ(promotion.verdict, PromotionVerdict::kError) << error;
    EXPECT_THAT(promotion.reason, HasSubstr("over its own data"));
  }
  const auto later = ScoresOf({0.1, 0.05, kInfinity}, {0.5, 0.2, 0.2});
  const auto promotion = PromotionByScores(kSoundScores, kPromotionLimits, HeldOut(later));
  EXPECT_EQ(promotion.verdict, PromotionVerdict::kError);
  EXPECT_THAT(promotion.reason, HasSubstr("the last 60 s, predicted from the first 240 s"));
}

TEST(Promotion, ComparesWithConstantVelocityOnDataSetAside) {
  struct Comparison {
    std::array<double, 3> model;
    std::array<double, 3> constant_velocity;
    PromotionVerdict verdict;
  };
  const std::vector<Comparison> comparisons = {
      // Sway is no better: a warning. No velocity is better: an error.
      {{0.1, 0.3, 0.02}, {0.5, 0.2, 0.2}, PromotionVerdict::kWarn},
      {{0.5, 0.2, 0.2}, {0.5, 0.2, 0.2}, PromotionVerdict::kError},
      // Below 0.1 m/s and 0.05 rad/s the noise decides: sway and yaw do not count.
      {{0.1, 0.09, 0.04}, {0.5, 0.08, 0.03}, PromotionVerdict::kOk},
      {{0.6, 0.01, 0.01}, {0.5, 0.08, 0.03}, PromotionVerdict::kError},
      {{0.02, 0.02, 0.02}, {0.01, 0.01, 0.01}, PromotionVerdict::kOk},
  };
  for (const Comparison& c : comparisons) {
    const auto promotion = PromotionByScores(kSoundScores, kPromotionLimits,
                                             HeldOut(ScoresOf(c.model, c.constant_velocity)));
    EXPECT_EQ(promotion.verdict, c.verdict) << promotion.reason;
    EXPECT_EQ(promotion.reason.empty(), c.verdict == PromotionVerdict::kOk);
  }
  const auto sway = PromotionByScores(kSoundScores, kPromotionLimits,
                                      HeldOut(ScoresOf({0.1, 0.3, 0.02}, {0.5, 0.2, 0.2})));
  EXPECT_THAT(sway.reason, HasSubstr("sway errs by 0.300 m/s and constant velocity by 0.200"));
}

TEST(Promotion, WarnsOfAModelThatLacksAnEquation) {
  const Identification without_equations;
  const auto promotion = AssessPromotion({}, YellowfishVehicle(), without_equations, {});
  EXPECT_EQ(promotion.verdict, PromotionVerdict::kWarn);
  EXPECT_THAT(promotion.reason, HasSubstr("equation"));
}

// Three minutes of a boat that free coefficients describe: the two forms err by different amounts.
TEST(Promotion, IsByTheScoreOfAModelOfTheSameStructure) {
  const auto track = Simulate(YellowfishTwin(), {}, SampleMission(1), 180.0, 0.02);
  const Recording recording = Measure(track, YellowfishVehicle(), {});
  IdentifyOptions free;
  free.threads = 2;
  IdentifyOptions physically = free;
  physically.regression.structure = Structure::kFossen;
  const auto model = Identify(recording, YellowfishVehicle(), physically);
  ASSERT_TRUE(model);
  const auto expected = ScoreOnHeldOutPart(recording, YellowfishVehicle(), physically);
  const auto score = ScoreOnHeldOutPart(recording, YellowfishVehicle(), *model, free);
  ASSERT_TRUE(expected);
  ASSERT_TRUE(score);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(score->metrics.free_run.front().velocity[i].rmse,
              expected->metrics.free_run.front().velocity[i].rmse);
  }
}

}  // namespace
}  // namespace telltale
