#include "telltale/core/data/north_east_frame.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

// Length of one degree at a latitude, WGS84: the table "Length of a degree" of Wikipedia's article
// Latitude, from a = 6378137 m and 1/f = 298.257223563.
struct DegreeLength {
  double latitude_deg;
  double north_km;
  double east_km;
};
constexpr DegreeLength kDegreeLengths[] = {{0, 110.574, 111.320}, {15, 110.649, 107.550},
                                           {30, 110.852, 96.486}, {45, 111.132, 78.847},
                                           {60, 111.412, 55.800}, {75, 111.618, 28.902}};

TEST(NorthEastFrame, ADegreeHasItsPublishedLength) {
  for (const DegreeLength& truth : kDegreeLengths) {
    const NorthEastFrame frame({truth.latitude_deg, 10.0});
    const auto north = frame.Forward({truth.latitude_deg + 0.0005, 10.0}).north_m -
                       frame.Forward({truth.latitude_deg - 0.0005, 10.0}).north_m;
    const auto east = frame.Forward({truth.latitude_deg, 10.0005}).east_m -
                      frame.Forward({truth.latitude_deg, 9.9995}).east_m;
    // A thousandth of a degree in metres reads as a degree in kilometres; the table has three
    // places.
    EXPECT_NEAR(north, truth.north_km, 6e-4) << truth.latitude_deg;
    EXPECT_NEAR(east, truth.east_km, 6e-4) << truth.latitude_deg;
  }
}

TEST(NorthEastFrame, OriginIsZeroAndAxesPointNorthAndEast) {
  const NorthEastFrame frame({-33.9, 151.2});
  EXPECT_NEAR(frame.Forward({-33.9, 151.2}).north_m, 0.0, 1e-9);
  EXPECT_GT(frame.Forward({-33.8, 151.2}).north_m, 0.0);
  EXPECT_GT(frame.Forward({-33.9, 151.3}).east_m, 0.0);
}

TEST(NorthEastFrame, InverseUndoesForward) {
  const NorthEastFrame frame({63.4, 10.3});
  for (double north = -1e5; north <= 1e5; north += 2e4) {
    for (double east = -1e5; east <= 1e5; east += 2e4) {
      const auto back = frame.Forward(frame.Inverse({north, east}));
      ASSERT_NEAR(back.north_m, north, 1e-6);
      ASSERT_NEAR(back.east_m, east, 1e-6);
    }
  }
}

TEST(NorthEastFrame, CrossesTheDateLineWithoutAJump) {
  const NorthEastFrame frame({0.0, 179.9999});
  EXPECT_NEAR(frame.Forward({0.0, -179.9999}).east_m, 2e-4 * 111320.0, 0.01);
}

}  // namespace
}  // namespace telltale
