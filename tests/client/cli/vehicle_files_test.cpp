#include <gtest/gtest.h>

#include "telltale/client/workbench/files.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

const std::filesystem::path kSource = TELLTALE_SOURCE_DIR;

void ExpectSame(const PwmChannel& a, const PwmChannel& b) {
  EXPECT_EQ(a.neutral_us, b.neutral_us);
  EXPECT_EQ(a.full_forward_us, b.full_forward_us);
  EXPECT_EQ(a.full_reverse_us, b.full_reverse_us);
}

TEST(VehicleFiles, TheSampleIsTheYellowfish) {
  const Vehicle file = LoadVehicle(kSource / "deploy/sample/yellowfish.textproto");
  const Vehicle boat = YellowfishVehicle();
  EXPECT_EQ(file.vehicle_id, boat.vehicle_id);
  EXPECT_EQ(file.propeller_separation_m, boat.propeller_separation_m);
  ExpectSame(file.port, boat.port);
  ExpectSame(file.starboard, boat.starboard);
  EXPECT_EQ(file.gnss_antenna.forward_m, boat.gnss_antenna.forward_m);
  EXPECT_EQ(file.gnss_antenna.starboard_m, boat.gnss_antenna.starboard_m);
  EXPECT_EQ(file.mass_kg, boat.mass_kg);
}

TEST(VehicleFiles, TheBlueBoatHasAReversedStarboardChannel) {
  const Vehicle boat = LoadVehicle(kSource / "docs/vehicles/blueboat.textproto");
  EXPECT_EQ(boat.port.Normalise(1911), 1.0);
  EXPECT_EQ(boat.starboard.Normalise(1111), 1.0);
  EXPECT_EQ(boat.starboard.Normalise(1911), -1.0);
}

TEST(VehicleFiles, EveryVehicleInTheDocumentationCanBeRead) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "docs/vehicles")) {
    EXPECT_NO_THROW(LoadVehicle(entry.path())) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 2u);
}

}  // namespace
}  // namespace telltale
