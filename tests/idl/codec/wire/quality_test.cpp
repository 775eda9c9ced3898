#include "telltale/idl/codec/wire/quality.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(WireQuality, CarriesAProposalAndWhatIsKnownOfADrift) {
  Quality quality;
  quality.vehicle_id = "boat-1";
  EXPECT_EQ(Decode(*Encode(quality))->proposal, "");
  EXPECT_EQ(Decode(*Encode(quality))->drift_evidence, "");
  quality.proposal = "ask why";
  EXPECT_EQ(Decode(*Encode(quality))->drift_untested, "");
  quality.drift_evidence = "port thruster 14 % weaker";
  quality.drift_untested = "drag: too little has come yet";
  EXPECT_EQ(Decode(*Encode(quality))->proposal, "ask why");
  EXPECT_EQ(Decode(*Encode(quality))->drift_evidence, "port thruster 14 % weaker");
  EXPECT_EQ(Decode(*Encode(quality))->drift_untested, "drag: too little has come yet");
}

TEST(WireQuality, ArrivesAsItWasSent) {
  Quality sent;
  sent.vehicle_id = "boat-1";
  sent.window_fill = 0.5;
  sent.lost = 3;
  sent.shed = {5, 6, 7};
  sent.shed_share = 0.75;
  sent.window_bytes = 4096;
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
  EXPECT_EQ(received->shed, sent.shed);
  EXPECT_EQ(received->shed_share, 0.75);
  EXPECT_EQ(received->window_bytes, 4096u);
  EXPECT_EQ(received->rejected, sent.rejected);
  EXPECT_EQ(received->model_revision, 2u);
  EXPECT_EQ(received->drift, -0.25);
  EXPECT_EQ(received->indicative, sent.indicative);
  EXPECT_EQ(received->indicative_rows, 2417u);
}

TEST(WireQuality, CarriesTheVerdictWithWhatItRestsOn) {
  Quality sent;
  sent.vehicle_id = "boat-1";
  EXPECT_EQ(Decode(*Encode(sent))->verdict, QualityVerdict::kUnknown);
  sent.verdict = QualityVerdict::kError;
  sent.verdict_since_unix_s = 1.5e9;
  sent.reasons = {{"DRIFT", QualityVerdict::kError, "no longer matches"},
                  {"LOST", QualityVerdict::kWarn, "7 %"}};
  sent.silent_s = 0.25;
  sent.loss_share = 0.07;
  sent.reject_share = 0.01;
  sent.drift_since_unix_s = 1.4e9;
  sent.coefficients = 35;
  sent.identified = 30;
  sent.relative_half_width = 0.125;
  sent.last_refusal = Refusal{"surge", "not excited", "zigzag"};
  sent.diagnosis_verdict = "EXPLAINED";
  sent.diagnosis_sentence = "The starboard thruster is weak.";
  sent.diagnosed_unix_s = 1.45e9;
  sent.position = QualityPosition{59.5, -10.25, 359.0};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->verdict, sent.verdict);
  EXPECT_EQ(received->verdict_since_unix_s, sent.verdict_since_unix_s);
  EXPECT_EQ(received->reasons, sent.reasons);
  EXPECT_EQ(received->silent_s, sent.silent_s);
  EXPECT_EQ(received->loss_share, sent.loss_share);
  EXPECT_EQ(received->reject_share, sent.reject_share);
  EXPECT_EQ(received->drift_since_unix_s, sent.drift_since_unix_s);
  EXPECT_EQ(received->coefficients, 35u);
  EXPECT_EQ(received->identified, 30u);
  EXPECT_EQ(received->relative_half_width, sent.relative_half_width);
  EXPECT_EQ(received->last_refusal->reason, "not excited");
  EXPECT_EQ(received->diagnosis_verdict, sent.diagnosis_verdict);
  EXPECT_EQ(received->diagnosis_sentence, sent.diagnosis_sentence);
  EXPECT_EQ(received->diagnosed_unix_s, sent.diagnosed_unix_s);
  EXPECT_EQ(received->position, sent.position);
}

TEST(WireQuality, CarriesTheVerdictAndTheDelaysOfTheModel) {
  Quality sent;
  sent.vehicle_id = "boat-1";
  EXPECT_EQ(Decode(*Encode(sent))->model_verdict, Promotion());
  EXPECT_TRUE(Decode(*Encode(sent))->delays.empty());
  sent.model_verdict = {PromotionVerdict::kWarn, "it lacks an equation"};
  sent.delays = {{Channel::kGnss, 0.25, 0.125, 0.375}, {Channel::kThrusters, -0.5, -0.75, 0.0}};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->model_verdict, sent.model_verdict);
  EXPECT_EQ(received->delays, sent.delays);
}

TEST(WireQuality, RefusesAVerdictAndAPositionThatAreNone) {
  Quality sent;
  sent.vehicle_id = "boat-1";
  sent.position = QualityPosition{91.0, 0.0, {}};
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "position[0].latitude_deg");
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
