#include "telltale/client/bridge/live_mavlink_vehicle.hpp"

#include <bit>
#include <vector>

#include <gtest/gtest.h>

namespace telltale {
namespace {

using Payload = std::vector<std::uint8_t>;

constexpr double kUtcOfBootS = 1.7e9;

void Put(Payload& payload, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) {
    payload.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
  }
}

/// An autopilot that says what it is told to say, and the telemetry that comes of it.
class LiveMavlinkVehicleTest : public testing::Test {
 protected:
  void SystemTime(double unix_s, double boot_s, double arrival_s) {
    Payload payload;
    Put(payload, static_cast<std::uint64_t>(unix_s * 1e6), 8);
    Put(payload, static_cast<std::uint64_t>(boot_s * 1e3), 4);
    Take(MavlinkSystemTime::kId, payload, arrival_s);
  }
  void Attitude(double boot_s, double arrival_s) {
    Payload payload;
    Put(payload, static_cast<std::uint64_t>(boot_s * 1e3), 4);
    Put(payload, 0, 8);
    Put(payload, std::bit_cast<std::uint32_t>(0.5F), 4);
    Take(MavlinkAttitude::kId, payload, arrival_s);
  }
  void Outputs(std::uint32_t time_us, double arrival_s) {
    Payload payload;
    Put(payload, time_us, 4);
    for (int output = 1; output <= 8; ++output)
      Put(payload, 1500u + 10u * static_cast<unsigned>(output), 2);
    Take(MavlinkServoOutputRaw::kId, payload, arrival_s);
  }
  void Fix(double time_s, std::uint8_t fix_type, double arrival_s) {
    Payload payload;
    Put(payload, static_cast<std::uint64_t>(time_s * 1e6), 8);
    Put(payload, 634000000, 4);
    Put(payload, 104000000, 4);
    payload.resize(28);
    payload.push_back(fix_type);
    Take(MavlinkGpsRawInt::kId, payload, arrival_s);
  }
  void Position(double boot_s, double arrival_s) {
    Payload payload;
    Put(payload, static_cast<std::uint64_t>(boot_s * 1e3), 4);
    Put(payload, 630000000, 4);
    payload.resize(28);
    Take(MavlinkGlobalPositionInt::kId, payload, arrival_s);
  }

  std::uint64_t Rejected(MavlinkReject reason) const { return vehicle_.Rejected(reason); }
  std::vector<double> Times() const {
    std::vector<double> times;
    for (const RawSample& sample : samples_) times.push_back(TimeOf(sample));
    return times;
  }

  LiveMavlinkVehicle vehicle_{1, 3};
  std::vector<RawSample> samples_;

 private:
  void Take(std::uint32_t message, const Payload& payload, double arrival_s) {
    vehicle_.Take({2, 1, 1, message, payload}, arrival_s,
                  [this](const RawSample& sample) { samples_.push_back(sample); });
  }
};

TEST_F(LiveMavlinkVehicleTest, TakesTheClockFromSystemTime) {
  Attitude(9.9, 0.0);
  SystemTime(kUtcOfBootS + 10.0, 10.0, 0.1);
  Attitude(10.1, 0.2);
  SystemTime(kUtcOfBootS + 15.0, 11.0, 1.1);  // set later: the first holds
  Attitude(11.1, 1.2);
  EXPECT_EQ(Times(), (std::vector{kUtcOfBootS + 10.1, kUtcOfBootS + 11.1}));
  EXPECT_EQ(Rejected(MavlinkReject::kClockUnknown), 1u);
  EXPECT_TRUE(vehicle_.ClockFromSystemTime());
}

TEST_F(LiveMavlinkVehicleTest, TakesTheLeastDelayedArrivalWhereUtcIsUnknown) {
  SystemTime(0.0, 10.0, 1000.5);
  Attitude(11.0, 1001.25);  // the least delayed
  Attitude(13.0, 1003.75);
  Attitude(14.0, 1004.5);
  ASSERT_EQ(samples_.size(), 2u);
  EXPECT_DOUBLE_EQ(Times().back(), 14.0 + 990.25);
  EXPECT_FALSE(vehicle_.ClockFromSystemTime());
}

TEST_F(LiveMavlinkVehicleTest, TakesTheClockAnewAfterABoot) {
  SystemTime(kUtcOfBootS + 5000.0, 5000.0, 0.0);
  SystemTime(kUtcOfBootS + 5030.0, 2.0, 30.0);
  Attitude(2.5, 30.5);
  EXPECT_EQ(vehicle_.Boots(), 2u);
  EXPECT_EQ(Times(), std::vector{kUtcOfBootS + 5030.5});
}

TEST_F(LiveMavlinkVehicleTest, FindsTheRoundOfOutputs) {
  SystemTime(kUtcOfBootS + 4300.0, 4300.0, 0.0);
  Outputs(5032704, 0.0);  // 4300 s less 2^32 us
  ASSERT_EQ(samples_.size(), 1u);
  EXPECT_NEAR(Times()[0], kUtcOfBootS + 4300.0, 1e-6);
  const auto& commands = std::get<ThrusterSample>(samples_[0]);
  EXPECT_EQ(commands.port_us, 1510.0);
  EXPECT_EQ(commands.starboard_us, 1530.0);
}

TEST_F(LiveMavlinkVehicleTest, RejectsByReason) {
  SystemTime(kUtcOfBootS + 100.0, 100.0, 0.0);
  Fix(100.0, 2, 0.0);
  Fix(100.0, 3, 0.1);
  Fix(100.0, 3, 0.2);
  Fix(50.0, 3, 0.3);
  Fix(kUtcOfBootS + 101.0, 3, 1.0);  // on the UNIX clock
  EXPECT_EQ(Times(), (std::vector{kUtcOfBootS + 100.0, kUtcOfBootS + 101.0}));
  EXPECT_EQ(Rejected(MavlinkReject::kNoFix), 1u);
  EXPECT_EQ(Rejected(MavlinkReject::kRepeatedFix), 1u);
  EXPECT_EQ(Rejected(MavlinkReject::kOtherClock), 1u);
}

TEST_F(LiveMavlinkVehicleTest, TakesFilteredPositionsWhereNoFixComes) {
  SystemTime(kUtcOfBootS + 100.0, 100.0, 0.0);
  Fix(100.0, 3, 0.0);
  Position(100.5, 0.5);
  EXPECT_EQ(samples_.size(), 1u);
  Position(103.5, 3.5);
  ASSERT_EQ(samples_.size(), 3u);  // with its heading, since no ATTITUDE came either
  EXPECT_DOUBLE_EQ(std::get<GnssFix>(samples_[1]).latitude_deg, 63.0);
}

TEST_F(LiveMavlinkVehicleTest, WaitsForTheNamesOfOutputs) {
  LiveMavlinkVehicle unnamed(std::nullopt, std::nullopt);
  const Payload payload(21);
  unnamed.Take({2, 1, 1, MavlinkServoOutputRaw::kId, payload}, 0.0, [](const RawSample&) {});
  EXPECT_EQ(unnamed.Rejected(MavlinkReject::kUnknownOutputs), 1u);
  EXPECT_FALSE(unnamed.PortChannel());
}

}  // namespace
}  // namespace telltale
