#include "telltale/service/ingest/fleet.hpp"

#include <gtest/gtest.h>

#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

TEST(Fleet, FindsItsVehiclesAndCountsTheRest) {
  Vehicle one = YellowfishVehicle();
  one.vehicle_id = "one";
  Fleet fleet({one}, WindowLimits());
  ASSERT_NE(fleet.Find("one"), nullptr);
  EXPECT_EQ(fleet.Find("one")->vehicle().vehicle_id, "one");
  EXPECT_EQ(fleet.Find("two"), nullptr);
  fleet.CountUnattributed("gnss", Name(UnattributedReason::kUnknownVehicle));
  fleet.CountUnattributed("gnss", Name(UnattributedReason::kUnknownVehicle));
  fleet.CountUnreadable("telltale/telemetry/heading");
  fleet.CountUnreadable("telltale/vehicle");
  fleet.CountUnreadable("telltale/model");
  EXPECT_EQ(fleet.Unattributed(), (std::vector<RejectEntry>{{"gnss", "UNKNOWN_VEHICLE", 2},
                                                            {"heading", "UNREADABLE", 1},
                                                            {"vehicle", "UNREADABLE", 1}}));
}

/// As many headings as come in `duration_s`, 50 in each.
void SendHeadings(VehicleWindow& window, int duration_s) {
  for (std::uint64_t i = 1; i <= 50 * static_cast<std::uint64_t>(duration_s); ++i) {
    window.Add(i, HeadingSample{0.02 * static_cast<double>(i), static_cast<double>(i % 360)});
  }
}

// 512 KiB are 256 KiB for each of two, which hold 16384 headings of 16 bytes; of three, 170 KiB.
TEST(Fleet, SharesItsMemoryEvenlyAmongTheVehiclesThatItServes) {
  std::vector<Vehicle> vehicles(3, YellowfishVehicle());
  for (std::size_t i = 0; i < vehicles.size(); ++i) vehicles[i].vehicle_id = std::to_string(i);
  Fleet fleet({vehicles[0], vehicles[1]}, WindowLimits(), 512u << 10);
  VehicleWindow& first = fleet.WindowOf("0");
  SendHeadings(first, 400);
  EXPECT_EQ(first.State().bytes, 256u << 10);
  EXPECT_EQ(first.Snapshot().heading.size(), 16384u);
  const auto generation = fleet.Generation();
  fleet.Reload(vehicles);
  EXPECT_NE(fleet.Generation(), generation);
  EXPECT_EQ(first.State().bytes, (512u << 10) / 3 / 16 * 16);
  fleet.Reload({vehicles[2]});
  EXPECT_EQ(first.State().bytes, WindowLimits::kLeastMemory);
}

TEST(Fleet, GivesEveryVehicleTheLeastMemory) {
  std::vector<Vehicle> vehicles(3, YellowfishVehicle());
  for (std::size_t i = 0; i < vehicles.size(); ++i) vehicles[i].vehicle_id = std::to_string(i);
  Fleet fleet(vehicles, WindowLimits(), 3000);
  SendHeadings(fleet.WindowOf("1"), 200);
  EXPECT_EQ(fleet.WindowOf("1").State().bytes, WindowLimits::kLeastMemory);
}

}  // namespace
}  // namespace telltale
