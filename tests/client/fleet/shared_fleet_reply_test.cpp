#include "telltale/client/fleet/shared_fleet_reply.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::ElementsAre;

constexpr SliceSet kLowerHalf = 0xffff'ffff;
constexpr SliceSet kUpperHalf = ~kLowerHalf;

FleetRequest RequestOf(FleetCommand command, std::vector<std::string> vehicle_ids = {}) {
  FleetRequest request;
  request.command = command;
  request.vehicle_ids = std::move(vehicle_ids);
  return request;
}

FleetReply ReplyOf(SliceSet slices, ReplyOutcome outcome = ReplyOutcome::kAnswered) {
  FleetReply reply;
  reply.outcome = outcome;
  reply.slices = slices;
  return reply;
}

FleetReply ListOf(SliceSet slices, const std::vector<std::string>& vehicle_ids) {
  FleetReply reply = ReplyOf(slices);
  for (const std::string& vehicle_id : vehicle_ids) {
    reply.vehicles.push_back({vehicle_id, 0.0, 0.0, 0, 0.0, {}});
  }
  return reply;
}

std::vector<std::string> IdsOf(const FleetReply& reply) {
  std::vector<std::string> ids;
  for (const VehicleSummary& vehicle : reply.vehicles) ids.push_back(vehicle.vehicle_id);
  return ids;
}

TEST(SharedFleetReply, IsCompleteOnceEverySliceIsAnsweredFor) {
  const FleetRequest list = RequestOf(FleetCommand::kList);
  SharedFleetReply shared(list);
  EXPECT_FALSE(shared.IsComplete());
  shared.Add(ListOf(kUpperHalf, {"boat-3", "boat-1"}));
  EXPECT_FALSE(shared.IsComplete());
  EXPECT_EQ(UnansweredSlices(list, *shared.reply()), kLowerHalf);
  shared.Add(ListOf(kUpperHalf, {"boat-3", "boat-1"}));  // it was asked again
  shared.Add(ListOf(kLowerHalf, {"boat-2"}));
  EXPECT_TRUE(shared.IsComplete());
  EXPECT_THAT(IdsOf(*shared.reply()), ElementsAre("boat-1", "boat-2", "boat-3"));
}

TEST(SharedFleetReply, OfAnOlderDaemonIsOfTheWholeFleet) {
  const FleetRequest list = RequestOf(FleetCommand::kList);
  SharedFleetReply shared(list);
  shared.Add(ListOf(0, {"boat-1"}));
  EXPECT_TRUE(shared.IsComplete());
  EXPECT_EQ(UnansweredSlices(list, *shared.reply()), 0u);
}

// CRC-32 as python3 -c 'import zlib; print(zlib.crc32(b"boat-1") % 64)' gives it: 17, 43.
TEST(SharedFleetReply, WaitsForTheSlicesOfTheVehiclesThatAreNamed) {
  EXPECT_EQ(SlicesAskedBy(RequestOf(FleetCommand::kRefresh, {"boat-1", "boat-2"})),
            SetOf(17) | SetOf(43));
  SharedFleetReply shared(RequestOf(FleetCommand::kRefresh, {"boat-1"}));
  shared.Add(ReplyOf(kUpperHalf));
  EXPECT_FALSE(shared.IsComplete());
  shared.Add(ReplyOf(kLowerHalf));
  EXPECT_TRUE(shared.IsComplete());
}

TEST(SharedFleetReply, TakesTheWordOfWhoKnowsTheVehicle) {
  SharedFleetReply shared(RequestOf(FleetCommand::kRefresh));
  FleetReply knows = ReplyOf(kLowerHalf);
  knows.refreshed = {{"boat-1", RefreshState::kPublished, 4, PromotionVerdict::kOk, ""}};
  FleetReply knows_not = ReplyOf(kUpperHalf);
  knows_not.refreshed = {
      {"boat-1", RefreshState::kFailed, 0, PromotionVerdict::kUnknown, "is not served here"}};
  shared.Add(knows_not);
  shared.Add(knows);
  shared.Add(knows_not);
  EXPECT_EQ(shared.reply()->refreshed, knows.refreshed);
}

TEST(SharedFleetReply, OfACancelIsThatOfTheDaemonThatHasTheRequest) {
  SharedFleetReply shared(RequestOf(FleetCommand::kCancel));
  FleetReply knows_not = ReplyOf(kLowerHalf, ReplyOutcome::kFailed);
  knows_not.message = "no such request waits";
  shared.Add(knows_not);
  EXPECT_FALSE(shared.IsComplete());
  shared.Add(ReplyOf(SetOf(40)));
  EXPECT_TRUE(shared.IsComplete());
  EXPECT_EQ(shared.reply()->outcome, ReplyOutcome::kAnswered);
  EXPECT_EQ(shared.reply()->message, "");
}

}  // namespace
}  // namespace telltale
