#include "telltale/idl/codec/json/metrics.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using testing::HasSubstr;

Metrics MadeUpMetrics() {
  Metrics metrics;
  metrics.one_step = {OneStepScore{0.9, 0.01, 0.5}, OneStepScore{0.8, 0.02, 0.4},
                      OneStepScore{0.7, 0.03, 0.3}};
  metrics.free_run = {
      {5.0,
       {{{0.1, 0.2, 0.3, 0.4, 0.5}, {1.1, 1.2, 1.3, 1.4, 1.5}, {2.1, 2.2, 2.3, 2.4, 2.5}}},
       1.0 / 3.0,
       12}};
  return metrics;
}

TEST(MetricsJson, PrintedAndReadAgainIsTheSame) {
  const Metrics metrics = MadeUpMetrics();
  const auto again = ParseMetricsJson(PrintMetricsJson(metrics));
  ASSERT_TRUE(again) << again.error().Message();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again->one_step[i].r2, metrics.one_step[i].r2);
    EXPECT_EQ(again->one_step[i].mae, metrics.one_step[i].mae);
    EXPECT_EQ(again->one_step[i].constant_velocity_r2, metrics.one_step[i].constant_velocity_r2);
    const FreeRunScore& a = again->free_run.at(0).velocity[i];
    const FreeRunScore& b = metrics.free_run[0].velocity[i];
    EXPECT_EQ(a.rmse, b.rmse);
    EXPECT_EQ(a.mae, b.mae);
    EXPECT_EQ(a.r2, b.r2);
    EXPECT_EQ(a.constant_velocity_rmse, b.constant_velocity_rmse);
    EXPECT_EQ(a.noise_floor, b.noise_floor);
  }
  EXPECT_EQ(again->free_run[0].horizon_s, 5.0);
  EXPECT_EQ(again->free_run[0].position_rmse_m, 1.0 / 3.0);
  EXPECT_EQ(again->free_run[0].windows, 12u);
}

TEST(MetricsJson, UsesTheNamesOfTheInterface) {
  const std::string json = PrintMetricsJson(MadeUpMetrics());
  for (const char* text :
       {"\"oneStep\"", "\"surge\"", "\"sway\"", "\"yaw\"", "\"r2\"", "\"mae\"", "\"persistenceR2\"",
        "\"freeRun\"", "\"horizonS\": 5", "\"rmse\"", "\"persistenceRmse\"", "\"noiseFloor\"",
        "\"positionRmseM\"", "\"windows\": 12"}) {
    EXPECT_THAT(json, HasSubstr(text));
  }
}

TEST(MetricsJson, AScoreTheDataCannotGiveStaysNan) {
  Metrics metrics = MadeUpMetrics();
  metrics.one_step[0].r2 = std::numeric_limits<double>::quiet_NaN();
  const auto again = ParseMetricsJson(PrintMetricsJson(metrics));
  ASSERT_TRUE(again) << again.error().Message();
  EXPECT_TRUE(std::isnan(again->one_step[0].r2));
}

TEST(MetricsJson, RefusesWhatIsNotMetrics) {
  EXPECT_EQ(ParseMetricsJson("{\"oneStep\": {\"heave\": {}}}").error().field, "oneStep.heave");
  EXPECT_EQ(ParseMetricsJson("{\"oneStep\": {\"yaw\": {\"r2\": \"x\"}}}").error().field,
            "oneStep.yaw.r2");
  EXPECT_FALSE(ParseMetricsJson("{"));
}

}  // namespace
}  // namespace telltale
