#include "telltale/core/diagnosis/residuals/horizon_runs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/resting_boat.hpp"

namespace telltale {
namespace {

TEST(BuildFreeRuns, HasEachHorizonAndKnowsTheMainOne) {
  const testing::RestingBoat boat(90.0);
  const auto runs = BuildFreeRuns(boat.dataset, {boat.dataset, boat.dataset}, boat.model, 2);
  ASSERT_TRUE(runs);
  ASSERT_EQ(runs->horizons.size(), 3U);
  EXPECT_EQ(runs->horizons[0].recording.HorizonS(), 1.0);
  EXPECT_EQ(runs->Main().recording.HorizonS(), 5.0);
  EXPECT_EQ(runs->Main().references.size(), 2U);
}

TEST(BuildFreeRuns, LeavesOutAHorizonLongerThanEverySegment) {
  const testing::RestingBoat boat(90.0);
  PreparedDataset cut = boat.dataset;
  cut.segments.clear();
  for (std::size_t begin = 0; begin + 30 <= boat.dataset.rows.size(); begin += 30) {
    cut.segments.push_back({begin, begin + 30});  // 6 s
  }
  cut.commands.assign(cut.segments.size(), boat.dataset.commands.front());
  cut.signals.assign(cut.segments.size(), boat.dataset.signals.front());
  const auto runs = BuildFreeRuns(cut, {boat.dataset}, boat.model, 2);
  ASSERT_TRUE(runs);
  EXPECT_EQ(runs->horizons.size(), 2U);
  EXPECT_EQ(runs->Main().recording.HorizonS(), 5.0);
}

TEST(BuildFreeRuns, RefusesWhatHasTooFewWindows) {
  const testing::RestingBoat boat(90.0);
  const testing::RestingBoat brief(30.0);
  const auto of_brief = BuildFreeRuns(brief.dataset, {boat.dataset}, boat.model, 2);
  ASSERT_FALSE(of_brief);
  EXPECT_EQ(of_brief.error().subject, "recording");
  EXPECT_THAT(of_brief.error().reason, ::testing::HasSubstr("windows of five seconds"));
  const auto without_reference = BuildFreeRuns(boat.dataset, {}, boat.model, 2);
  ASSERT_FALSE(without_reference);
  EXPECT_EQ(without_reference.error().subject, "reference");
}

}  // namespace
}  // namespace telltale
