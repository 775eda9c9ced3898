#include "telltale/idl/codec/wire/fleet_exchange.hpp"

#include <gtest/gtest.h>

#include "idl/codec/wire/wire_support.hpp"
#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"

namespace telltale {
namespace {

TEST(WireFleetExchange, RequestArrivesAsItWasSent) {
  FleetRequest sent;
  sent.correlation_id = "abc-1";
  sent.command = FleetCommand::kRefresh;
  sent.vehicle_ids = {"one", "two"};
  sent.all = true;
  sent.revision = 7;
  sent.worse_than = PromotionVerdict::kWarn;
  sent.older_than_s = 3600.0;
  sent.target = "other";
  sent.deadline_s = 12.5;
  sent.before_unix_s = 1.7e9;
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->correlation_id, "abc-1");
  EXPECT_EQ(received->command, FleetCommand::kRefresh);
  EXPECT_EQ(received->vehicle_ids, sent.vehicle_ids);
  EXPECT_TRUE(received->all);
  EXPECT_EQ(received->revision, 7u);
  EXPECT_EQ(received->worse_than, PromotionVerdict::kWarn);
  EXPECT_EQ(received->older_than_s, 3600.0);
  EXPECT_EQ(received->target, "other");
  EXPECT_EQ(received->deadline_s, 12.5);
  EXPECT_EQ(received->before_unix_s, 1.7e9);
}

TEST(WireFleetExchange, RequestNamesItsFault) {
  FleetRequest sent;
  sent.correlation_id = "abc-1";
  sent.command = FleetCommand::kHistory;
  sent.vehicle_ids = {"one"};
  auto wire = Encode(sent);
  Replace(wire->command, "EXPLODE");
  EXPECT_EQ(Decode(*wire).error().field, "command");
  wire = Encode(sent);
  Replace(wire->vehicle_ids._buffer[0], "two words");
  EXPECT_EQ(Decode(*wire).error().field, "vehicle_ids[0]");
  wire = Encode(sent);
  Replace(wire->worse_than, "BAD");
  EXPECT_EQ(Decode(*wire).error().field, "worse_than");
  wire = Encode(sent);
  wire->older_than_s = -1.0;
  EXPECT_EQ(Decode(*wire).error().field, "older_than_s");
}

TEST(WireFleetExchange, ProgressAndReplyArriveAsTheyWereSent) {
  const RefreshedVehicle vehicle{"one", RefreshState::kPublished, 4, PromotionVerdict::kWarn,
                                 "sway"};
  const auto progress = Decode(*Encode(FleetProgress{"abc-1", 12, {vehicle}}));
  ASSERT_TRUE(progress) << progress.error().Message();
  EXPECT_EQ(progress->total, 12u);
  EXPECT_EQ(progress->vehicles, std::vector{vehicle});

  FleetReply sent;
  sent.correlation_id = "abc-1";
  sent.outcome = ReplyOutcome::kAnswered;
  sent.elapsed_s = 2.0;
  sent.vehicles = {{"one", 100.0, 0.5, 4, 60.0, {PromotionVerdict::kError, "it diverges"}},
                   {"two", 0.0, 0.0, 0, 0.0, {}}};
  sent.models = {{4, 1.7e9, "STATIC_QUADRATIC", "WEAK_IV", 1.0, 2.0, 500, {}}};
  sent.refreshed = {vehicle};
  sent.later_models = {{MadeUpIdentification(), 4, 1.5}};
  sent.earlier_diagnoses = {{MadeUpDiagnosis(), 3, 2.5}};
  sent.slices = SetOf(0) | SetOf(63);
  const auto reply = Decode(*Encode(sent));
  ASSERT_TRUE(reply) << reply.error().Message();
  EXPECT_EQ(reply->outcome, ReplyOutcome::kAnswered);
  EXPECT_EQ(reply->vehicles, sent.vehicles);
  EXPECT_EQ(reply->models, sent.models);
  EXPECT_EQ(reply->refreshed, sent.refreshed);
  ASSERT_EQ(reply->later_models.size(), 1u);
  EXPECT_EQ(reply->later_models[0].revision, 4u);
  EXPECT_EQ(reply->later_models[0].published_unix_s, 1.5);
  ASSERT_EQ(reply->earlier_diagnoses.size(), 1u);
  EXPECT_EQ(reply->earlier_diagnoses[0].model_revision, 3u);
  EXPECT_EQ(reply->earlier_diagnoses[0].published_unix_s, 2.5);
  EXPECT_EQ(reply->earlier_diagnoses[0].diagnosis.sentence, MadeUpDiagnosis().sentence);
  EXPECT_EQ(reply->slices, sent.slices);
  auto wire = Encode(sent);
  wire->vehicles._buffer[0].window_fill = 1.5;
  EXPECT_EQ(Decode(*wire).error().field, "vehicles[0].window_fill");
}

}  // namespace
}  // namespace telltale
