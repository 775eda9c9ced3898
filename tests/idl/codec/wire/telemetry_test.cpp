#include "telltale/idl/codec/wire/telemetry.hpp"

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/special_values.hpp"
#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

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

}  // namespace
}  // namespace telltale
