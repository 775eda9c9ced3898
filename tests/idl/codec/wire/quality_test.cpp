#include "telltale/idl/codec/wire/quality.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

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
