#include "telltale/core/identification/clock_alignment.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coverage/independent_simulator.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

/// Half an hour of a boat that no code of the estimators simulates.
Recording Recorded(const coverage::Clocks& clocks) {
  coverage::SimulatedEnvironment environment;
  environment.clocks = clocks;
  return Simulate(coverage::ReferenceBoat(), environment, {}, 24);
}

coverage::Clocks Apart() {
  coverage::Clocks clocks;
  clocks.command_delay_s = -0.08;
  clocks.least_fix_delay_s = clocks.greatest_fix_delay_s = 0.12;
  return clocks;
}

AlignedDataset Aligned(const coverage::Clocks& clocks) {
  return *PrepareWithClocksAligned(Recorded(clocks), coverage::VehicleOf(), {});
}

Result<Identification> Identified(std::optional<Estimator> estimator) {
  IdentifyOptions options;
  options.advise = false;
  options.estimator = estimator;
  return Identify(Recorded(Apart()), coverage::VehicleOf(), options);
}

const Refusal* WarningOf(const Identification& model) {
  const auto found = std::find_if(model.refusals.begin(), model.refusals.end(),
                                  [](const Refusal& r) { return r.subject == "clocks"; });
  return found == model.refusals.end() ? nullptr : &*found;
}

TEST(WithoutDelays, MovesCommandsToWhenTheyActAndFixesToWhenTheBoatWasThere) {
  Recording recording;
  recording.gnss = {{10.0, 37.0, -6.0}};
  recording.heading = {{10.0, 0.0}};
  recording.thrusters = {{10.0, 1500.0, 1500.0}};
  recording.starts_s = {10.0};
  const Recording moved = WithoutDelays(recording, {-0.05, 0.2});
  EXPECT_DOUBLE_EQ(moved.thrusters[0].time_s, 9.95);
  EXPECT_DOUBLE_EQ(moved.gnss[0].time_s, 9.8);
  EXPECT_DOUBLE_EQ(moved.heading[0].time_s, 10.0);
  EXPECT_DOUBLE_EQ(moved.starts_s[0], 9.8);
}

TEST(ClockAlignment, LeavesClocksThatAgreeAlone) {
  const AlignedDataset aligned = Aligned({});
  EXPECT_FALSE(aligned.removed.Any());
  EXPECT_EQ(aligned.dataset.sensors.command_spread_s, 0.0);
}

TEST(ClockAlignment, FindsTheDelaysOfCommandsAndOfFixes) {
  const auto [dataset, removed, errors] = Aligned(Apart());
  EXPECT_NEAR(removed.commands_s, -0.08, 4.0 * errors.commands_s);
  EXPECT_NEAR(removed.fixes_s, 0.12, 4.0 * errors.fixes_s);
  EXPECT_LT(errors.commands_s, 0.01);
  EXPECT_LT(errors.fixes_s, 0.01);
}

// Commands that change at any time, written down twice a second, are a quarter of a second old.
TEST(ClockAlignment, FindsHowOldSampledCommandsAre) {
  coverage::Clocks clocks;
  clocks.sampled = true;
  clocks.command_period_s = 0.5;
  const auto [dataset, removed, errors] = Aligned(clocks);
  EXPECT_NEAR(removed.commands_s, -0.25, 4.0 * errors.commands_s);
  EXPECT_NEAR(dataset.sensors.command_spread_s, 0.5, 8.0 * errors.commands_s);
}

TEST(ClockAlignment, IsReportedAndItsBoundsHold) {
  const auto model = Identified(std::nullopt);
  ASSERT_TRUE(model.has_value());
  EXPECT_EQ(model->estimator, Estimator::kWeakIv);
  EXPECT_THAT(model->provenance.estimator_choice, HasSubstr("clocks disagree"));
  const Refusal* warning = WarningOf(*model);
  ASSERT_NE(warning, nullptr);
  EXPECT_THAT(warning->reason, HasSubstr("before their stamps"));
  EXPECT_THAT(warning->reason, HasSubstr("late"));
  const std::vector<double> truth = CoefficientsOf(coverage::ReferenceBoat());
  int held = 0;
  for (std::size_t j = 0; j < model->coefficients.size(); ++j) {
    const Interval& interval = model->coefficients[j].interval;
    held += truth[j] >= interval.lower && truth[j] <= interval.upper ? 1 : 0;
  }
  // Of 35 independent intervals that hold with 95 % at least 30 do with a probability of 99 %.
  EXPECT_GE(held, 30);
}

TEST(ClockAlignment, SaysThatBoundsOfOutputErrorDoNotCarryTheDelays) {
  const auto model = Identified(Estimator::kOutputError);
  ASSERT_TRUE(model.has_value());
  const Refusal* warning = WarningOf(*model);
  ASSERT_NE(warning, nullptr);
  EXPECT_THAT(warning->reason, HasSubstr("hold too seldom"));
}

}  // namespace
}  // namespace telltale
