#include "telltale/core/paper/paper_mission.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

/// The paper: "16,025 data points ... 127 trajectory segments, resulting in 53.42 minutes".
TEST(PaperMission, HasThePapersSize) {
  const auto mission = PaperMission(1);
  ASSERT_EQ(mission.size(), 127u);
  std::size_t points = 0;
  for (const PaperSegment& segment : mission) points += segment.points;
  EXPECT_EQ(points, 16025u);
  EXPECT_NEAR(static_cast<double>(points) * 0.2 / 60.0, 53.42, 0.005);
}

/// "with a higher concentration of data within the {f,r} and {r,f} zones", and none in {r,r}.
TEST(PaperMission, TurnsMoreThanItGoesStraightAndNeverReverses) {
  std::map<PropellerRegion, double> seconds;
  for (const PaperSegment& segment : PaperMission(1)) {
    const double end_s = static_cast<double>(segment.points) * 0.2;
    for (std::size_t i = 0; i < segment.commands.size(); ++i) {
      const double until_s =
          i + 1 < segment.commands.size() ? segment.commands[i + 1].time_s : end_s;
      seconds[RegionOf(segment.commands[i].delta)] +=
          std::max(0.0, std::min(until_s, end_s) - segment.commands[i].time_s);
    }
  }
  EXPECT_EQ(seconds[PropellerRegion::kRR], 0.0);
  EXPECT_GT(seconds[PropellerRegion::kFR] + seconds[PropellerRegion::kRF],
            0.9 * seconds[PropellerRegion::kFF]);
  EXPECT_GT(seconds[PropellerRegion::kFF], 600.0);
}

TEST(RecordPaperMission, KeepsSegmentsApartAndTheBoatWithinItsSpeeds) {
  for (const VesselModel& boat : {YellowfishTwin(), YellowfishLaggingTwin()}) {
    const Recording recording = RecordPaperMission(boat, {}, 1);
    const auto dataset = Prepare(recording, YellowfishVehicle(), PrepareOptions::Robust());
    ASSERT_TRUE(dataset.has_value());
    EXPECT_EQ(dataset->segments.size(), 127u);
    // The grid may begin or end a row off the fixes at each segment.
    EXPECT_NEAR(static_cast<double>(dataset->rows.size()), 16025.0, 127.0);
    for (const PreparedRow& row : dataset->rows) {
      ASSERT_LT(std::abs(row.nu.u), 3.0) << row.time_s;
      ASSERT_LT(std::abs(row.nu.v), 2.0) << row.time_s;
      ASSERT_LT(std::abs(row.nu.r), 3.0) << row.time_s;
    }
  }
}

/// By hand from the table's surge column: alpha = 0.9031 - sqrt(0.9031^2 - 0.7725) = 0.6955.
TEST(YellowfishLaggingTwin, TakesItsLagFromTheSurgeColumn) {
  EXPECT_NEAR(std::exp(-0.2 / *YellowfishLaggingTwin().thruster_time_constant_s), 0.6955, 1e-4);
}

}  // namespace
}  // namespace telltale
