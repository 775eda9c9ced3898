#include "telltale/idl/codec/wire/wire.hpp"

#include <cmath>
#include <cstring>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

PublishedModel MadeUpModel() {
  return {MadeUpIdentification(), 7, 1700000700.5};
}

void ExpectSame(const PublishedModel& a, const PublishedModel& b) {
  EXPECT_EQ(a.revision, b.revision);
  EXPECT_EQ(a.published_unix_s, b.published_unix_s);
  ExpectSame(a.identification, b.identification);
}

TEST(WireTelemetry, ArrivesAsItWasSent) {
  const auto gnss = Decode(Encode(Telemetry<GnssFix>{"boat-1", 41, {1.5, -33.25, 151.125}}));
  ASSERT_TRUE(gnss);
  EXPECT_EQ(gnss->sequence_number, 41u);
  EXPECT_EQ(gnss->sample.time_s, 1.5);
  EXPECT_EQ(gnss->sample.latitude_deg, -33.25);
  EXPECT_EQ(gnss->sample.longitude_deg, 151.125);

  const auto heading = Decode(Encode(Telemetry<HeadingSample>{"boat-1", 42, {2.5, 359.75}}));
  ASSERT_TRUE(heading);
  EXPECT_EQ(heading->sample.heading_deg, 359.75);

  const auto thrusters =
      Decode(Encode(Telemetry<ThrusterSample>{"boat-1", 43, {3.5, 1900.0, 1100.0}}));
  ASSERT_TRUE(thrusters);
  EXPECT_EQ(thrusters->sample.port_us, 1900.0);
  EXPECT_EQ(thrusters->sample.starboard_us, 1100.0);
}

TEST(WireTelemetry, PortIsLeftOnTheWire) {
  const auto wire = Encode(Telemetry<ThrusterSample>{"boat-1", 1, {0.0, 1900.0, 1100.0}});
  EXPECT_EQ(wire.left_us, 1900.0);
  EXPECT_EQ(wire.right_us, 1100.0);
}

TEST(WireTelemetry, LeavesNumbersToTheWindow) {
  const auto decoded = Decode(Encode(Telemetry<GnssFix>{"boat-1", 1, {kNan, 1e9, 0.0}}));
  ASSERT_TRUE(decoded);
  EXPECT_TRUE(std::isnan(decoded->sample.time_s));
}

TEST(WireTelemetry, RefusesAVehicleIdThatIsNotTerminated) {
  auto wire = Encode(Telemetry<GnssFix>{"boat-1", 1, {}});
  std::memset(wire.vehicle_id, 'x', sizeof wire.vehicle_id);
  const auto decoded = Decode(wire);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().field, "vehicle_id");
  EXPECT_THAT(decoded.error().value, testing::HasSubstr("not terminated"));
}

TEST(WireTelemetry, RefusesCharactersThatNoVehicleIdHas) {
  for (const char* id : {"", "two words", "semi;colon", "new\nline", "\xc3\xbc", "../up", "*"}) {
    auto wire = Encode(Telemetry<HeadingSample>{"boat-1", 1, {}});
    std::strcpy(wire.vehicle_id, id);
    EXPECT_FALSE(Decode(wire)) << id;
  }
}

TEST(WireTelemetry, TakesTheLongestVehicleId) {
  const std::string longest(64, 'b');
  const auto wire = Encode(Telemetry<GnssFix>{longest, 1, {}});
  const auto decoded = Decode(wire);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->vehicle_id, longest);
}

TEST(WireTelemetry, SendingAWrongVehicleIdIsABrokenContract) {
  EXPECT_THROW(Encode(Telemetry<GnssFix>{"two words", 1, {}}), ContractViolation);
  EXPECT_THROW(Encode(Telemetry<GnssFix>{std::string(65, 'b'), 1, {}}), ContractViolation);
}

TEST(WireModel, ArrivesAsItWasSent) {
  const PublishedModel sent = MadeUpModel();
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ExpectSame(*received, sent);
}

TEST(WireModel, CarriesTheThrusterTimeConstant) {
  const PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ExpectSame(*received, sent);
}

/// That a reader takes neither what is no number nor one too few in `numbers`, called `field`.
void ExpectANumberForEachCoefficient(const PublishedModel& sent,
                                     dds_sequence_double telltale_wire_Model::*numbers,
                                     const std::string& field) {
  auto wire = Encode(sent);
  ((*wire).*numbers)._buffer[2] = kNan;
  EXPECT_EQ(Decode(*wire).error().field, field);
  wire = Encode(sent);
  ((*wire).*numbers)._length -= 1;
  EXPECT_EQ(Decode(*wire).error().value, "34 numbers");
}

TEST(WireModel, CarriesTheSimulationParameters) {
  const PublishedModel sent{MadeUpIdentificationWithSimulationParameters(), 8, 1700000700.5};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ExpectSame(*received, sent);
  ExpectANumberForEachCoefficient(sent, &telltale_wire_Model::simulation, "simulation");
}

TEST(WireModel, AnOlderWriterSendsNoCovarianceOfTheTimeConstant) {
  PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  sent.identification.time_constant_covariance.resize(0);
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->identification.time_constant_covariance, Eigen::VectorXd::Zero(35));
}

TEST(WireModel, TheCovarianceOfTheTimeConstantHasANumberForEachCoefficient) {
  PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  ExpectANumberForEachCoefficient(sent, &telltale_wire_Model::thruster_time_constant_covariance,
                                  "thruster_time_constant_covariance");
  sent.identification.structure = Structure::kStaticQuadratic;
  sent.identification.thruster_time_constant.reset();
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant_covariance");
}

TEST(WireModel, TheTimeConstantGoesWithTheDynamicStructure) {
  PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  sent.identification.thruster_time_constant->estimate = 0.0;
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant[0].estimate");
  sent.identification.thruster_time_constant.reset();
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant");
  sent = {MadeUpDynamicIdentification(), 8, 1700000700.5};
  sent.identification.structure = Structure::kStaticQuadratic;
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant");
}

struct Spoilt {
  const char* field;
  std::function<void(telltale_wire_Model&)> spoil;
};

void Replace(char*& text, const char* other) {
  dds_string_free(text);
  text = other == nullptr ? nullptr : dds_string_dup(other);
}

TEST(WireModel, NamesTheFieldThatIsWrong) {
  const std::vector<Spoilt> cases = {
      {"vehicle_id", [](auto& m) { std::memset(m.vehicle_id, 'x', sizeof m.vehicle_id); }},
      {"structure", [](auto& m) { Replace(m.structure, "CUBIC"); }},
      {"structure", [](auto& m) { Replace(m.structure, nullptr); }},
      {"parameterization", [](auto& m) { Replace(m.parameterization, "UNKNOWN"); }},
      {"estimator", [](auto& m) { Replace(m.estimator, "GUESS"); }},
      {"sampling_period_s", [](auto& m) { m.sampling_period_s = 0.0; }},
      {"sampling_period_s", [](auto& m) { m.sampling_period_s = kNan; }},
      {"coefficients[3].equation",
       [](auto& m) { Replace(m.coefficients._buffer[3].equation, "HEAVE"); }},
      {"coefficients[3].status", [](auto& m) { Replace(m.coefficients._buffer[3].status, ""); }},
      {"coefficients[3].estimate", [](auto& m) { m.coefficients._buffer[3].estimate = kNan; }},
      {"coefficients[3].standard_error",
       [](auto& m) { m.coefficients._buffer[3].standard_error = -1.0; }},
      {"coefficients[3].bounds.level",
       [](auto& m) { m.coefficients._buffer[3].bounds.level = 1.5; }},
      {"coefficients[3].bounds.upper",
       [](auto& m) { m.coefficients._buffer[3].bounds.upper = -1e6; }},
      {"covariance", [](auto& m) { m.covariance._length -= 1; }},
      {"covariance", [](auto& m) { m.covariance._buffer[5] = kNan; }},
      {"joint[0].covariance_factor", [](auto& m) { m.joint._buffer[0].covariance_factor = -1.0; }},
      {"joint[0].degrees_of_freedom",
       [](auto& m) { m.joint._buffer[0].degrees_of_freedom = kNan; }},
      {"dead_zone_forward", [](auto& m) { m.dead_zone_forward = 0.31; }},
      {"dead_zone_reverse", [](auto& m) { m.dead_zone_reverse = kNan; }},
      {"window_end_s", [](auto& m) { m.window_end_s = m.window_start_s - 1.0; }},
      {"rejected[0].reason", [](auto& m) { Replace(m.rejected._buffer[0].reason, "BORED"); }},
      {"rejected[0].channel", [](auto& m) { Replace(m.rejected._buffer[0].channel, "sonar"); }},
      {"published_unix_s", [](auto& m) { m.published_unix_s = kNan; }},
      {"misspecification", [](auto& m) { m.misspecification = -1.0; }},
  };
  for (const Spoilt& spoilt : cases) {
    auto wire = Encode(MadeUpModel());
    spoilt.spoil(*wire);
    const auto decoded = Decode(*wire);
    ASSERT_FALSE(decoded) << spoilt.field;
    EXPECT_EQ(decoded.error().field, spoilt.field);
    EXPECT_FALSE(decoded.error().allowed.empty());
  }
}

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

TEST(WireDiagnosis, ArrivesAsItWasSent) {
  const PublishedDiagnosis sent{MadeUpDiagnosis(), 7, 1700000700.5};
  const auto wire = Encode(sent);
  EXPECT_STREQ(wire->verdict, "PARTLY_EXPLAINED");
  EXPECT_EQ(wire->sentence, sent.diagnosis.sentence);
  const auto received = Decode(*wire);
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->model_revision, 7u);
  EXPECT_EQ(received->published_unix_s, 1700000700.5);
  ExpectSame(received->diagnosis, sent.diagnosis);
}

TEST(WireDiagnosis, RefusesAReportThatIsNoneOrOfAnotherVehicle) {
  auto wire = Encode(PublishedDiagnosis{MadeUpDiagnosis(), 7, 1700000700.5});
  std::strcpy(wire->vehicle_id, "another");
  EXPECT_EQ(Decode(*wire).error().field, "vehicle_id");
  wire->report[0] = 'x';
  EXPECT_FALSE(Decode(*wire));
}

TEST(WireDiagnosis, RequestAndProgressArriveAsTheyWereSent) {
  const auto request = Decode(*Encode(DiagnoseRequest{"id-1", "boat-1", true, {"wind", "x"}, 9}));
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

TEST(WireDiagnosis, ReplyHoldsADiagnosisWhenPublishedAndOnlyThen) {
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

TEST(WireDiagnosis, ReplyCarriesTheModelIdentifiedAgainWithItsEffects) {
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

TEST(WireQuality, CarriesAProposal) {
  Quality quality;
  quality.vehicle_id = "boat-1";
  EXPECT_EQ(Decode(*Encode(quality))->proposal, "");
  quality.proposal = "ask why";
  EXPECT_EQ(Decode(*Encode(quality))->proposal, "ask why");
}

TEST(WireQuality, ArrivesAsItWasSent) {
  Quality sent;
  sent.vehicle_id = "boat-1";
  sent.window_fill = 0.5;
  sent.lost = 3;
  sent.rejected = {{"gnss", "NOT_FINITE", 4}};
  sent.model_revision = 2;
  sent.drift = -0.25;
  sent.indicative = {{Equation::kSurge, "f:d", "W11bf", 0.25, 0.0125, "m/s^2"},
                     {Equation::kYaw, "r", "Rr3", -0.75, 0.5, "1/s"}};
  sent.indicative_rows = 2417;
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->vehicle_id, "boat-1");
  EXPECT_EQ(received->window_fill, 0.5);
  EXPECT_EQ(received->lost, 3u);
  EXPECT_EQ(received->rejected, sent.rejected);
  EXPECT_EQ(received->model_revision, 2u);
  EXPECT_EQ(received->drift, -0.25);
  EXPECT_EQ(received->indicative, sent.indicative);
  EXPECT_EQ(received->indicative_rows, 2417u);
}

TEST(WireQuality, SpeaksOfSamplesThatNameNoVehicle) {
  Quality sent;
  sent.vehicle_id = kUnattributed;
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->vehicle_id, kUnattributed);
}

}  // namespace
}  // namespace telltale
