#include "telltale/client/recording/ros/ros_recording.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/ros_messages.hpp"

namespace telltale {
namespace {

constexpr std::int64_t kSecondNs = 1000000000;

void Take(RosRecording& recording, std::string_view topic, std::string_view type,
          std::int64_t received_ns, const std::vector<std::uint8_t>& message) {
  recording.Open({topic, type, {}})(received_ns, message);
}

TEST(RosRecording, TakesPositionsHeadingsAndOutputs) {
  RosRecording recording{SourceOptions{}};
  Take(recording, "/fix", "sensor_msgs/msg/NavSatFix", 100 * kSecondNs, NavSatFix(100, 0));
  Take(recording, "/fix", "sensor_msgs/msg/NavSatFix", 101 * kSecondNs, NavSatFix(101, -1));
  // East-north-up: yaw 30 degrees from east is heading 60 degrees.
  Take(recording, "/imu", "sensor_msgs/msg/Imu", 100 * kSecondNs, Imu(100, M_PI / 6, "base_link"));
  Take(recording, "/rc/out", "mavros_msgs/msg/RCOut", 100 * kSecondNs,
       RcOut(100, {1600, 1500, 1400}));
  const SourceLog log = std::move(recording).Finish();
  ASSERT_TRUE(log.Lacks().empty()) << log.summary;
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_EQ(log.gnss[0].time_s, 100.0);
  EXPECT_EQ(log.gnss[0].latitude_deg, 63.4);
  EXPECT_NEAR(log.heading.at(0).heading_deg, 60.0, 1e-9);
  EXPECT_EQ(log.thrusters.at(0).port_us, 1600.0);
  EXPECT_EQ(log.thrusters.at(0).starboard_us, 1400.0);
  EXPECT_THAT(log.summary, testing::HasSubstr("1 positions without a fix in /fix"));
}

TEST(RosRecording, ThinsWhatOutgrowsItsMemoryAndSaysSo) {
  SourceOptions options;
  options.memory_bytes = 50'000;
  RosRecording recording(options);
  constexpr int kSeconds = 60;
  constexpr std::int64_t kRateHz = 200;
  for (std::int64_t i = 0; i < kSeconds * kRateHz; ++i) {
    const std::int64_t at_ns = i * kSecondNs / kRateHz;
    Take(recording, "/boat/heading", "std_msgs/msg/Float64", at_ns, Cdr().Add(10.0).Bytes());
    if (i % kRateHz != 0) continue;
    const auto second = static_cast<std::int32_t>(i / kRateHz);
    Take(recording, "/fix", "sensor_msgs/msg/NavSatFix", at_ns, NavSatFix(second, 0));
  }
  const SourceLog log = std::move(recording).Finish();
  EXPECT_EQ(log.gnss.size(), 60u);
  EXPECT_EQ(log.heading.size(), 60u * 25u);
  EXPECT_THAT(log.summary, testing::HasSubstr("thinned by whole samples to 25 Hz"));
}

TEST(RosRecording, TakesTheChannelsOfOneBoatFromARecordingOfTwo) {
  RosRecording recording{SourceOptions{}};
  for (int i = 0; i < 3; ++i) {
    const auto take = [&](const std::string& topic, const char* type,
                          const std::vector<std::uint8_t>& bytes) {
      Take(recording, topic, type, (100 + i) * kSecondNs, bytes);
    };
    // The second boat has most fixes, the first most of all else.
    if (i < 2) take("/boat1/mavros/fix", "sensor_msgs/msg/NavSatFix", NavSatFix(100 + i, 0));
    take("/boat2/mavros/fix", "sensor_msgs/msg/NavSatFix", NavSatFix(100 + i, 0));
    take("/boat1/mavros/imu", "sensor_msgs/msg/Imu", Imu(100 + i, 0.0, "base_link"));
    take("/boat1/mavros/out", "mavros_msgs/msg/RCOut", RcOut(100 + i, {1600, 1500, 1400}));
    if (i == 0) continue;
    take("/boat2/mavros/imu", "sensor_msgs/msg/Imu", Imu(100 + i, 0.0, "base_link"));
    take("/boat2/mavros/out", "mavros_msgs/msg/RCOut", RcOut(100 + i, {1600, 1500, 1400}));
  }
  const SourceLog log = std::move(recording).Finish();
  EXPECT_EQ(log.gnss.size(), 3u);
  EXPECT_EQ(log.heading.size(), 2u);
  EXPECT_EQ(log.thrusters.size(), 2u);
}

TEST(RosRecording, PrefersFixesOfTheReceiverToFilteredOnes) {
  RosRecording recording{SourceOptions{}};
  for (int i = 0; i < 3; ++i) {
    Take(recording, "/mavros/global_position/global", "sensor_msgs/msg/NavSatFix",
         (100 + i) * kSecondNs, NavSatFix(100 + i, 0));
  }
  Take(recording, "/mavros/global_position/raw/fix", "sensor_msgs/msg/NavSatFix", 100 * kSecondNs,
       NavSatFix(100, 0));
  const SourceLog log = std::move(recording).Finish();
  EXPECT_EQ(log.gnss.size(), 1u);
  EXPECT_THAT(log.summary, testing::HasSubstr("positions from /mavros/global_position/raw/fix"));
}

TEST(RosRecording, TakesTheLastChannelOfMoreThanDriveThrusters) {
  SourceOptions options;
  options.starboard_channel = 16;
  RosRecording recording(options);
  std::vector<std::uint16_t> pulses(18, 1500);
  pulses[15] = 1616;
  pulses[17] = 1818;
  Take(recording, "/rc/out", "mavros_msgs/msg/RCOut", 100 * kSecondNs, RcOut(100, pulses));
  const SourceLog log = std::move(recording).Finish();
  ASSERT_EQ(log.thrusters.size(), 1u);
  EXPECT_EQ(log.thrusters[0].port_us, 1500.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1616.0);
}

TEST(RosRecording, RefusesTheOutputThatIsPortByDefaultForStarboard) {
  SourceOptions options;
  options.starboard_channel = 1;
  RosRecording recording(options);
  Take(recording, "/rc/out", "mavros_msgs/msg/RCOut", 100 * kSecondNs, RcOut(100, {1600, 0, 1400}));
  const SourceLog log = std::move(recording).Finish();
  EXPECT_TRUE(log.thrusters.empty());
  EXPECT_EQ(log.Lacks().back().subject, "starboard_channel");
  EXPECT_EQ(log.Lacks().back().reason, "output 1 stands for both thrusters");
}

TEST(RosRecording, CountsOutputsWithTooFewChannels) {
  RosRecording recording{SourceOptions{}};
  Take(recording, "/rc/out", "mavros_msgs/msg/RCOut", 100 * kSecondNs, RcOut(100, {1600, 1500}));
  EXPECT_THAT(std::move(recording).Finish().summary,
              testing::HasSubstr("1 messages of /rc/out with fewer than 3 channels"));
}

TEST(RosRecording, TakesANorthEastDownFrameByItsName) {
  RosRecording recording{SourceOptions{}};
  Take(recording, "/imu", "sensor_msgs/msg/Imu", 0, Imu(1, M_PI / 6, "base_link_ned"));
  EXPECT_NEAR(std::move(recording).Finish().heading.at(0).heading_deg, 30.0, 1e-9);
}

TEST(RosRecording, TakesOdometryAsMetresFromAnOriginThatItNames) {
  const NorthEastFrame frame(kOdometryOrigin);
  const auto place = [&](const std::string& frame_id) {
    RosRecording recording{SourceOptions{}};
    Take(recording, "/odom", "nav_msgs/msg/Odometry", 100 * kSecondNs,
         Odometry(100, 30.0, -40.0, M_PI / 6, frame_id));
    const SourceLog log = std::move(recording).Finish();
    EXPECT_THAT(log.summary, testing::HasSubstr("positions from /odom (metres from an origin that "
                                                "is not stated, taken as 45 N 0 E)"));
    const GnssFix& fix = log.gnss.at(0);
    EXPECT_EQ(log.heading.size(), 1u);
    return frame.Forward({fix.latitude_deg, fix.longitude_deg});
  };
  // x is east of REP 103, and north of a frame that names NED.
  EXPECT_NEAR(place("odom").east_m, 30.0, 1e-6);
  EXPECT_NEAR(place("odom").north_m, -40.0, 1e-6);
  EXPECT_NEAR(place("odom_ned").north_m, 30.0, 1e-6);
  EXPECT_NEAR(place("odom_ned").east_m, -40.0, 1e-6);
}

TEST(RosRecording, PrefersPositionsOnTheEarthToOdometryHoweverFew) {
  RosRecording recording{SourceOptions{}};
  for (int i = 0; i < 5; ++i) {
    Take(recording, "/odom", "nav_msgs/msg/Odometry", i * kSecondNs,
         Odometry(i + 1, 1.0, 2.0, 0.0));
  }
  Take(recording, "/fix", "sensor_msgs/msg/NavSatFix", kSecondNs, NavSatFix(1, 0));
  const SourceLog log = std::move(recording).Finish();
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_EQ(log.gnss[0].latitude_deg, 63.4);
  EXPECT_THAT(log.summary,
              testing::HasSubstr("positions from /fix (the best type of 2 such topics)"));
}

TEST(RosRecording, TakesPositionAndHeadingOfAGeoPose) {
  RosRecording recording{SourceOptions{}};
  const auto take = [&](double latitude_deg, double longitude_deg) {
    Take(recording, "/ap/geopose/filtered", "geographic_msgs/msg/GeoPoseStamped", kSecondNs,
         GeoPose(1, latitude_deg, longitude_deg, M_PI / 6));
  };
  take(0.0, 0.0);  // no fix
  take(-35.36, 149.16);
  const SourceLog log = std::move(recording).Finish();
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_EQ(log.gnss[0].latitude_deg, -35.36);
  EXPECT_EQ(log.gnss[0].longitude_deg, 149.16);
  EXPECT_NEAR(log.heading.at(0).heading_deg, 60.0, 1e-9);
}

TEST(RosTopic, IsOfAThrusterWhereItsLastNameCommandsIt) {
  const auto kind = [](const char* name) { return RosTopic(name, "std_msgs/msg/Float64").Kind(); };
  // VRX in Gazebo, VRX of ROS 1, and names that people give.
  for (const char* name : {"/wamv/thrusters/left/thrust", "/wamv/thrusters/right_thrust_cmd",
                           "/pwm/port", "/thrusters/starboard", "/motor_left/cmd", "/left_motor"}) {
    EXPECT_EQ(kind(name), RosKind::kSide) << name;
  }
  for (const char* name :
       {"/wamv/thrusters/left/pos", "/wamv/thrusters/left_thrust_angle",
        "/wamv/thrusters/left/ang_vel", "/motor_left/temperature", "/thrusters/left/rpm"}) {
    EXPECT_EQ(kind(name), RosKind::kUnknown) << name;
  }
}

TEST(RosRecording, PrefersACompassToAnOrientation) {
  RosRecording recording{SourceOptions{}};
  Take(recording, "/imu", "sensor_msgs/msg/Imu", 0, Imu(1, 0.0, "map"));
  Take(recording, "/compass_hdg", "std_msgs/msg/Float64", kSecondNs, Cdr().Add(123.0).Bytes());
  const SourceLog log = std::move(recording).Finish();
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_EQ(log.heading[0].heading_deg, 123.0);
}

TEST(RosRecording, MakesPulsesOfSharesOfThrust) {
  RosRecording recording{SourceOptions{}};
  const auto share = [](double value) { return Cdr().Add(value).Bytes(); };
  Take(recording, "/thrusters/left/thrust", "std_msgs/msg/Float64", kSecondNs, share(0.5));
  Take(recording, "/thrusters/right/thrust", "std_msgs/msg/Float64", 2 * kSecondNs, share(-0.25));
  const SourceLog log = std::move(recording).Finish();
  ASSERT_EQ(log.thrusters.size(), 1u);
  EXPECT_EQ(log.thrusters[0].time_s, 2.0);
  EXPECT_EQ(log.thrusters[0].port_us, 1700.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1400.0);
}

TEST(RosRecording, LeavesThrustInNewtonsToAMapping) {
  RosRecording recording{SourceOptions{}};
  for (const char* side : {"/left/thrust", "/right/thrust"}) {
    Take(recording, side, "std_msgs/msg/Float64", kSecondNs, Cdr().Add(40.0).Bytes());
  }
  const SourceLog log = std::move(recording).Finish();
  EXPECT_TRUE(log.thrusters.empty());
  EXPECT_THAT(log.summary, testing::HasSubstr("values up to 40"));
}

TEST(RosRecording, UsesTimesOfRecordingWhereStampsAreOfAnotherClock) {
  RosRecording recording{SourceOptions{}};
  Take(recording, "/fix", "sensor_msgs/msg/NavSatFix", 5000 * kSecondNs, NavSatFix(100, 0));
  const SourceLog log = std::move(recording).Finish();
  EXPECT_EQ(log.gnss.at(0).time_s, 5000.0);
  EXPECT_THAT(log.summary, testing::HasSubstr("times of recording"));
}

TEST(RosRecording, CountsMessagesThatAreCutShort) {
  RosRecording recording{SourceOptions{}};
  auto bytes = NavSatFix(100, 0);
  bytes.resize(bytes.size() - 4);
  Take(recording, "/fix", "sensor_msgs/msg/NavSatFix", 0, bytes);
  Take(recording, "/fix", "sensor_msgs/msg/NavSatFix", 0, {});
  const SourceLog log = std::move(recording).Finish();
  EXPECT_TRUE(log.gnss.empty());
  EXPECT_THAT(log.summary, testing::HasSubstr("2 unreadable messages of /fix"));
}

}  // namespace
}  // namespace telltale
