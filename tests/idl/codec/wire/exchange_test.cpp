#include "telltale/idl/codec/wire/exchange.hpp"

#include <string>

#include <gtest/gtest.h>

#include "idl/codec/wire/wire_support.hpp"
#include "support/made_up_diagnoses.hpp"

namespace telltale {
namespace {

TEST(WireExchange, RequestArrivesAsItWasSent) {
  IdentifyRequest sent;
  sent.correlation_id = "abc-1";
  sent.vehicle_id = "boat-1";
  sent.parameterization = Parameterization::kPaper;
  sent.preset = Preset::kPaper;
  sent.bootstrap_replicates = 0;
  sent.seed = 99;
  sent.dead_zone_source = DeadZoneSource::kGiven;
  sent.dead_zone = {0.05, -0.0625};
  sent.include_reverse = true;
  sent.resampling = Resampling::kMovingBlocks;
  sent.interval_method = IntervalMethod::kBca;
  sent.recording_bias = RecordingBiasModel::kPerRecordingNorthEast;
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->correlation_id, sent.correlation_id);
  EXPECT_EQ(received->vehicle_id, sent.vehicle_id);
  EXPECT_EQ(received->structure, Structure::kUnknown);
  EXPECT_EQ(received->parameterization, Parameterization::kPaper);
  EXPECT_EQ(received->estimator, Estimator::kUnknown);
  EXPECT_EQ(received->preset, Preset::kPaper);
  EXPECT_EQ(received->bootstrap_replicates, 0u);
  EXPECT_EQ(received->seed, 99u);
  EXPECT_EQ(received->dead_zone_source, DeadZoneSource::kGiven);
  EXPECT_EQ(received->dead_zone, sent.dead_zone);
  EXPECT_TRUE(received->include_reverse);
  EXPECT_EQ(received->resampling, Resampling::kMovingBlocks);
  EXPECT_EQ(received->interval_method, IntervalMethod::kBca);
  EXPECT_EQ(received->recording_bias, RecordingBiasModel::kPerRecordingNorthEast);
  sent.resampling = Resampling::kUnknown;
  sent.interval_method = IntervalMethod::kUnknown;
  sent.recording_bias = RecordingBiasModel::kUnknown;
  const auto open = Decode(*Encode(sent));
  ASSERT_TRUE(open) << open.error().Message();
  EXPECT_EQ(open->resampling, Resampling::kUnknown);
  EXPECT_EQ(open->interval_method, IntervalMethod::kUnknown);
  EXPECT_EQ(open->recording_bias, RecordingBiasModel::kUnknown);
}

TEST(WireExchange, CarriesDeadlineAndTimeToAskAgain) {
  IdentifyRequest sent;
  sent.correlation_id = "abc-1";
  sent.vehicle_id = "boat-1";
  sent.deadline_s = 12.5;
  EXPECT_EQ(Decode(*Encode(sent))->deadline_s, 12.5);
  auto wire = Encode(sent);
  wire->deadline_s = -1.0;
  EXPECT_EQ(Decode(*wire).error().field, "deadline_s");
  DiagnoseReply busy;
  busy.correlation_id = "abc-1";
  busy.vehicle_id = "boat-1";
  busy.outcome = ReplyOutcome::kFailed;
  busy.retry_after_s = 4.0;
  EXPECT_EQ(Decode(*Encode(busy))->retry_after_s, 4.0);
}

TEST(WireExchange, NamesALongFaultInAShortLine) {
  IdentifyRequest sent;
  sent.correlation_id = "abc-1";
  sent.vehicle_id = "boat-1";
  auto wire = Encode(sent);
  Replace(wire->estimator, std::string(20'000'000, 'x').c_str());
  const std::string message = Decode(*wire).error().Message();
  EXPECT_LT(message.size(), 400u);
  EXPECT_NE(message.find("20000000 characters"), std::string::npos);
}

TEST(WireExchange, RequestLeavesReverseRowsOutUnlessItSaysOtherwise) {
  IdentifyRequest sent;
  sent.correlation_id = "abc-1";
  sent.vehicle_id = "boat-1";
  EXPECT_FALSE(Decode(*Encode(sent))->include_reverse);
}

TEST(WireExchange, RequestRefusesUnknownChoicesAndIdentifiers) {
  IdentifyRequest sent;
  sent.correlation_id = "abc-1";
  sent.vehicle_id = "boat-1";
  auto wire = Encode(sent);
  Replace(wire->estimator, "GUESS");
  EXPECT_EQ(Decode(*wire).error().field, "estimator");
  wire = Encode(sent);
  Replace(wire->dead_zone, "PERHAPS");
  EXPECT_EQ(Decode(*wire).error().field, "dead_zone");
  wire = Encode(sent);
  Replace(wire->resampling, "ROWS");
  EXPECT_EQ(Decode(*wire).error().field, "resampling");
  wire = Encode(sent);
  Replace(wire->interval_method, "BAYES");
  EXPECT_EQ(Decode(*wire).error().field, "interval_method");
  wire = Encode(sent);
  Replace(wire->recording_bias, "EACH");
  EXPECT_EQ(Decode(*wire).error().field, "recording_bias");
  wire = Encode(sent);
  wire->dead_zone_forward = -0.1;
  EXPECT_EQ(Decode(*wire).error().field, "dead_zone_forward");
  wire = Encode(sent);
  Replace(wire->correlation_id, std::string(65, 'c').c_str());
  EXPECT_EQ(Decode(*wire).error().field, "correlation_id");
  wire = Encode(sent);
  Replace(wire->correlation_id, nullptr);
  EXPECT_EQ(Decode(*wire).error().field, "correlation_id");
}

TEST(WireExchange, ReplyCarriesModelOrRefusals) {
  IdentifyReply published;
  published.correlation_id = "abc-1";
  published.vehicle_id = "boat-1";
  published.outcome = ReplyOutcome::kPublished;
  published.model = MadeUpModel();
  published.elapsed_s = 1.25;
  const auto received = Decode(*Encode(published));
  ASSERT_TRUE(received) << received.error().Message();
  ASSERT_TRUE(received->model);
  ExpectSame(*received->model, *published.model);
  EXPECT_EQ(received->elapsed_s, 1.25);

  IdentifyReply refused = published;
  refused.outcome = ReplyOutcome::kRefused;
  refused.model.reset();
  refused.refusals = {{"window", "is empty", "send telemetry"}};
  const auto second = Decode(*Encode(refused));
  ASSERT_TRUE(second) << second.error().Message();
  EXPECT_EQ(second->outcome, ReplyOutcome::kRefused);
  EXPECT_EQ(second->refusals, refused.refusals);
  EXPECT_FALSE(second->model);
}

TEST(WireExchange, ReplyMustHoldAModelWhenPublishedAndOnlyThen) {
  IdentifyReply reply;
  reply.correlation_id = "abc-1";
  reply.vehicle_id = "boat-1";
  reply.outcome = ReplyOutcome::kPublished;
  EXPECT_EQ(Decode(*Encode(reply)).error().field, "model");
  reply.outcome = ReplyOutcome::kFailed;
  reply.model = MadeUpModel();
  EXPECT_EQ(Decode(*Encode(reply)).error().field, "model");
}

TEST(WireExchange, ProgressStaysBetweenNoneAndAll) {
  auto wire = Encode(IdentifyProgress{{"abc-1", "boat-1", "bootstrap", 0.5}});
  EXPECT_EQ(Decode(*wire)->fraction, 0.5);
  wire->fraction = 1.5;
  EXPECT_EQ(Decode(*wire).error().field, "fraction");
}

TEST(WireExchange, RequestAndProgressArriveAsTheyWereSent) {
  const auto request = Decode(*Encode(DiagnoseRequest{{"id-1", "boat-1"}, true, {"wind", "x"}, 9}));
  ASSERT_TRUE(request) << request.error().Message();
  EXPECT_EQ(request->correlation_id, "id-1");
  EXPECT_EQ(request->vehicle_id, "boat-1");
  EXPECT_TRUE(request->refit);
  EXPECT_EQ(request->without, (std::vector<std::string>{"wind", "x"}));
  EXPECT_EQ(request->seed, 9u);
  const auto progress = Decode(*Encode(DiagnoseProgress{{"id-1", "boat-1", "searching", 0.25}}));
  ASSERT_TRUE(progress);
  EXPECT_EQ(progress->stage, "searching");
  EXPECT_EQ(progress->fraction, 0.25);
}

// Of bytes that are no UTF-8, a request that is kept on disk could not be read back.
TEST(WireExchange, RequestRefusesEffectsThatAreNoNames) {
  for (const std::string& effect :
       {std::string("c\xb3rrent"), std::string("two words"), std::string(), std::string(65, 'x')}) {
    const auto request = Decode(*Encode(DiagnoseRequest{{"id-1", "boat-1"}, false, {effect}, 1}));
    ASSERT_FALSE(request) << effect;
    EXPECT_EQ(request.error().field, "without[0]");
    EXPECT_EQ(request.error().allowed, "an effect of the library");
  }
}

TEST(WireExchange, ReplyHoldsADiagnosisWhenPublishedAndOnlyThen) {
  DiagnoseReply sent{
      {"id-1", "boat-1", ReplyOutcome::kRefused, "", {{"a", "b", "c"}}, 1.5}, {}, {}};
  const auto refused = Decode(*Encode(sent));
  ASSERT_TRUE(refused) << refused.error().Message();
  EXPECT_EQ(refused->refusals, sent.refusals);
  EXPECT_EQ(refused->elapsed_s, 1.5);
  sent.outcome = ReplyOutcome::kPublished;
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "diagnosis");
  sent.diagnosis = PublishedDiagnosis{MadeUpDiagnosis(), 7, 1.0};
  const auto published = Decode(*Encode(sent));
  ASSERT_TRUE(published) << published.error().Message();
  ExpectSame(published->diagnosis->diagnosis, sent.diagnosis->diagnosis);
  EXPECT_FALSE(published->augmented);
}

TEST(WireExchange, ReplyCarriesTheModelIdentifiedAgainWithItsEffects) {
  DiagnoseReply sent{{"id-1", "boat-1", ReplyOutcome::kPublished, "", {}, 1.5}, {}, {}};
  sent.diagnosis = PublishedDiagnosis{MadeUpDiagnosis(), 7, 1.0};
  sent.augmented = MadeUpIdentification();
  sent.augmented->vehicle_id = "boat-1";
  sent.augmented->effects = {{"thruster_lag", {0.25}}};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ASSERT_TRUE(received->augmented);
  ExpectSame(*received->augmented, *sent.augmented);
  ASSERT_EQ(received->augmented->effects.size(), 1u);
  EXPECT_EQ(received->augmented->effects[0].effect, "thruster_lag");

  DiagnoseReply other = sent;
  other.augmented->vehicle_id = "boat-2";
  EXPECT_EQ(Decode(*Encode(other)).error().field, "augmented[0].vehicle_id");
  DiagnoseReply refused = sent;
  refused.outcome = ReplyOutcome::kRefused;
  refused.diagnosis.reset();
  EXPECT_EQ(Decode(*Encode(refused)).error().field, "augmented");
}

}  // namespace
}  // namespace telltale
