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
  fleet.CountUnattributed("gnss", UnattributedReason::kUnknownVehicle);
  fleet.CountUnattributed("gnss", UnattributedReason::kUnknownVehicle);
  EXPECT_EQ(fleet.Unattributed(), (std::vector<RejectEntry>{{"gnss", "UNKNOWN_VEHICLE", 2}}));
}

}  // namespace
}  // namespace telltale
