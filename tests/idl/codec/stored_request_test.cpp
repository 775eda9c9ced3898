#include "telltale/idl/codec/stored_request.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(StoredRequest, ComesBackAsItWasWithTheTimeThatIsLeft) {
  IdentifyRequest identify;
  identify.correlation_id = "abc-1";
  identify.vehicle_id = "boat-1";
  identify.structure = Structure::kFirstOrderDynamic;
  identify.bootstrap_replicates = 0;
  identify.seed = 9;
  identify.dead_zone_source = DeadZoneSource::kGiven;
  identify.dead_zone = {0.05, -0.0625};
  identify.include_reverse = true;
  identify.coverage_check_replicates = 100;
  identify.deadline_s = 120.0;
  const auto read = ParseStoredRequest(SerialiseRequest(identify, 1000.0), 1030.0);
  ASSERT_TRUE(read) << read.error().Message();
  identify.deadline_s = 90.0;
  EXPECT_EQ(std::get<IdentifyRequest>(*read), identify);
  const auto late = ParseStoredRequest(SerialiseRequest(identify, 1000.0), 1100.0);
  EXPECT_LT(std::get<IdentifyRequest>(*late).deadline_s, 0.0);

  DiagnoseRequest diagnose;
  diagnose.correlation_id = "abc-2";
  diagnose.vehicle_id = "boat-1";
  diagnose.refit = true;
  diagnose.without = {"wind"};
  const auto again = ParseStoredRequest(SerialiseRequest(diagnose, 1000.0), 5000.0);
  EXPECT_EQ(std::get<DiagnoseRequest>(*again), diagnose);

  FleetRequest refresh;
  refresh.correlation_id = "abc-3";
  refresh.command = FleetCommand::kRefresh;
  refresh.vehicle_ids = {"boat-1", "boat-2"};
  refresh.worse_than = PromotionVerdict::kOk;
  const auto fleet = ParseStoredRequest(SerialiseRequest(refresh, 1000.0), 5000.0);
  ASSERT_TRUE(fleet) << fleet.error().Message();
  EXPECT_EQ(std::get<FleetRequest>(*fleet).vehicle_ids, refresh.vehicle_ids);
  EXPECT_EQ(std::get<FleetRequest>(*fleet).worse_than, PromotionVerdict::kOk);
}

TEST(StoredRequest, RefusesWhatIsNone) {
  EXPECT_EQ(ParseStoredRequest("\xff\xff", 0.0).error().field, "request");
  EXPECT_EQ(ParseStoredRequest("", 0.0).error().field, "kind");
}

}  // namespace
}  // namespace telltale
