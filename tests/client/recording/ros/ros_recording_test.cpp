#include "telltale/client/recording/ros/ros_recording.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

/// Little-endian CDR, aligned as OMG DDS-XTypes 7.4 says.
class Cdr {
 public:
  template <class Number>
  Cdr& Add(Number value) {
    while ((bytes_.size() - 4) % sizeof(Number) != 0) bytes_.push_back(0);
    std::uint64_t raw = 0;
    if constexpr (std::is_same_v<Number, double>) {
      raw = std::bit_cast<std::uint64_t>(value);
    } else {
      raw = static_cast<std::uint64_t>(value);
    }
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      bytes_.push_back(static_cast<std::uint8_t>(raw >> (8 * i) & 0xFF));
    }
    return *this;
  }
  Cdr& AddText(const std::string& text) {
    Add(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text) bytes_.push_back(static_cast<std::uint8_t>(c));
    bytes_.push_back(0);
    return *this;
  }
  Cdr& AddHeader(std::int32_t seconds, const std::string& frame = "map") {
    return Add(seconds).Add(std::uint32_t{0}).AddText(frame);
  }
  const std::vector<std::uint8_t>& Bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_ = {0, 1, 0, 0};
};

constexpr std::int64_t kSecondNs = 1000000000;

std::vector<std::uint8_t> NavSatFix(std::int32_t seconds, std::int8_t status) {
  return Cdr().AddHeader(seconds).Add(status).Add(std::uint16_t{1}).Add(63.4).Add(10.4).Bytes();
}

std::vector<std::uint8_t> Imu(std::int32_t seconds, double yaw_rad, const std::string& frame) {
  Cdr cdr;
  cdr.AddHeader(seconds, frame).Add(0.0).Add(0.0);
  cdr.Add(std::sin(yaw_rad / 2)).Add(std::cos(yaw_rad / 2));
  for (int i = 0; i < 9; ++i) cdr.Add(0.0);
  return cdr.Bytes();
}

std::vector<std::uint8_t> RcOut(std::int32_t seconds, std::vector<std::uint16_t> channels) {
  Cdr cdr;
  cdr.AddHeader(seconds).Add(static_cast<std::uint32_t>(channels.size()));
  for (const std::uint16_t us : channels) cdr.Add(us);
  return cdr.Bytes();
}

TEST(RosRecording, TakesPositionsHeadingsAndOutputs) {
  RosRecording recording;
  recording.Take("/fix", "sensor_msgs/msg/NavSatFix", 100 * kSecondNs, NavSatFix(100, 0));
  recording.Take("/fix", "sensor_msgs/msg/NavSatFix", 101 * kSecondNs, NavSatFix(101, -1));
  // East-north-up: yaw 30 degrees from east is heading 60 degrees.
  recording.Take("/imu", "sensor_msgs/msg/Imu", 100 * kSecondNs, Imu(100, M_PI / 6, "base_link"));
  recording.Take("/rc/out", "mavros_msgs/msg/RCOut", 100 * kSecondNs,
                 RcOut(100, {1600, 1500, 1400}));
  const SourceLog log = recording.Finish({});
  ASSERT_FALSE(log.Lacks()) << log.summary;
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_EQ(log.gnss[0].time_s, 100.0);
  EXPECT_EQ(log.gnss[0].latitude_deg, 63.4);
  EXPECT_NEAR(log.heading.at(0).heading_deg, 60.0, 1e-9);
  EXPECT_EQ(log.thrusters.at(0).port_us, 1600.0);
  EXPECT_EQ(log.thrusters.at(0).starboard_us, 1400.0);
  EXPECT_THAT(log.summary, testing::HasSubstr("1 positions without a fix in /fix"));
}

TEST(RosRecording, TakesANorthEastDownFrameByItsName) {
  RosRecording recording;
  recording.Take("/imu", "sensor_msgs/msg/Imu", 0, Imu(1, M_PI / 6, "base_link_ned"));
  EXPECT_NEAR(recording.Finish({}).heading.at(0).heading_deg, 30.0, 1e-9);
}

TEST(RosRecording, PrefersACompassToAnOrientation) {
  RosRecording recording;
  recording.Take("/imu", "sensor_msgs/msg/Imu", 0, Imu(1, 0.0, "map"));
  recording.Take("/compass_hdg", "std_msgs/msg/Float64", kSecondNs, Cdr().Add(123.0).Bytes());
  const SourceLog log = recording.Finish({});
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_EQ(log.heading[0].heading_deg, 123.0);
}

TEST(RosRecording, MakesPulsesOfSharesOfThrust) {
  RosRecording recording;
  const auto share = [](double value) { return Cdr().Add(value).Bytes(); };
  recording.Take("/thrusters/left/thrust", "std_msgs/msg/Float64", kSecondNs, share(0.5));
  recording.Take("/thrusters/right/thrust", "std_msgs/msg/Float64", 2 * kSecondNs, share(-0.25));
  const SourceLog log = recording.Finish({});
  ASSERT_EQ(log.thrusters.size(), 1u);
  EXPECT_EQ(log.thrusters[0].time_s, 2.0);
  EXPECT_EQ(log.thrusters[0].port_us, 1700.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1400.0);
}

TEST(RosRecording, LeavesThrustInNewtonsToAMapping) {
  RosRecording recording;
  for (const char* side : {"/left/thrust", "/right/thrust"}) {
    recording.Take(side, "std_msgs/msg/Float64", kSecondNs, Cdr().Add(40.0).Bytes());
  }
  const SourceLog log = recording.Finish({});
  EXPECT_TRUE(log.thrusters.empty());
  EXPECT_THAT(log.summary, testing::HasSubstr("values up to 40"));
}

TEST(RosRecording, UsesTimesOfRecordingWhereStampsAreOfAnotherClock) {
  RosRecording recording;
  recording.Take("/fix", "sensor_msgs/msg/NavSatFix", 5000 * kSecondNs, NavSatFix(100, 0));
  const SourceLog log = recording.Finish({});
  EXPECT_EQ(log.gnss.at(0).time_s, 5000.0);
  EXPECT_THAT(log.summary, testing::HasSubstr("times of recording"));
}

TEST(RosRecording, CountsMessagesThatAreCutShort) {
  RosRecording recording;
  auto bytes = NavSatFix(100, 0);
  bytes.resize(bytes.size() - 4);
  recording.Take("/fix", "sensor_msgs/msg/NavSatFix", 0, bytes);
  recording.Take("/fix", "sensor_msgs/msg/NavSatFix", 0, {});
  const SourceLog log = recording.Finish({});
  EXPECT_TRUE(log.gnss.empty());
  EXPECT_THAT(log.summary, testing::HasSubstr("2 unreadable messages of /fix"));
}

}  // namespace
}  // namespace telltale
