#include "telltale/service/monitoring/live_estimator.hpp"

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/recording_parts.hpp"

namespace telltale {
namespace {

/// Rows of a whole recording taken in piece by piece are those of the recording taken at once but
/// for what interpolation makes of the ends of pieces: a hundredth of an error bar, five allowed.
TEST(LiveEstimator, TellsTheSameHoweverItIsFed) {
  const Recording recording =
      testing::SimulateStableBoat(testing::StableBoat(), 300.0, SensorOptions(), 5);
  LiveEstimator at_once;
  at_once.Update(recording, testing::StableBoatVehicle());
  LiveEstimator by_pieces;
  for (double end_s = 10.0; end_s <= 300.0; end_s += 7.0) {
    const Recording until = Between(recording, -1.0, end_s);
    if (by_pieces.IsDue(end_s)) by_pieces.Update(until, testing::StableBoatVehicle());
  }
  by_pieces.Update(recording, testing::StableBoatVehicle());
  EXPECT_EQ(by_pieces.rows(), at_once.rows());
  const auto one = at_once.Estimates();
  const auto other = by_pieces.Estimates();
  ASSERT_EQ(one.size(), 35u);
  ASSERT_EQ(other.size(), 35u);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(one[i].estimate, other[i].estimate, 0.05 * one[i].standard_error);
  }
}

TEST(LiveEstimator, IsDueAfterSomeSecondsOrANewClock) {
  LiveEstimator feed;
  EXPECT_FALSE(feed.IsDue(4.0));
  feed.Update(testing::SimulateStableBoat(testing::StableBoat(), 60.0, SensorOptions(), 5),
              testing::StableBoatVehicle());
  EXPECT_FALSE(feed.IsDue(62.0));
  EXPECT_TRUE(feed.IsDue(65.0));
  EXPECT_TRUE(feed.IsDue(3.0));
}

}  // namespace
}  // namespace telltale
