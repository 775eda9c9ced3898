#include "telltale/client/bridge/live_ros_vehicle.hpp"

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/ros_messages.hpp"
#include "telltale/idl/codec/mapping_file.hpp"

namespace telltale {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr std::int32_t kNow = 1700000000;

/// One vehicle and what it has published and told.
class LiveRosVehicleTest : public testing::Test {
 protected:
  void Make(const SourceOptions& options = {}) {
    vehicle_ = std::make_unique<LiveRosVehicle>(
        options, [this](const RawSample& sample) { samples_.push_back(sample); },
        [this](const std::string& what) { told_.push_back(what); });
  }
  void SetUp() override { Make(); }

  void Take(const std::string& topic, const std::string& type,
            const std::vector<std::uint8_t>& bytes, double arrival_s) {
    vehicle_->Take(topic, type, bytes, arrival_s);
  }
  void TakeFix(double arrival_s, std::int32_t stamp_s, const std::string& topic = "/fix") {
    Take(topic, "sensor_msgs/msg/NavSatFix", NavSatFix(stamp_s, 0), arrival_s);
  }
  void TakeImu(double arrival_s, std::int32_t stamp_s, const std::string& topic = "/imu") {
    Take(topic, "sensor_msgs/msg/Imu", Imu(stamp_s, 0.0, "base_link"), arrival_s);
  }
  void TakeThrust(const std::string& side, double share, double arrival_s) {
    Take("/thrusters/" + side + "/thrust", "std_msgs/msg/Float64", Cdr().Add(share).Bytes(),
         arrival_s);
  }

  template <class Sample>
  std::vector<Sample> Of() const {
    std::vector<Sample> channel;
    for (const RawSample& sample : samples_) {
      if (const auto* one = std::get_if<Sample>(&sample)) channel.push_back(*one);
    }
    return channel;
  }

  std::unique_ptr<LiveRosVehicle> vehicle_;
  std::vector<RawSample> samples_;
  std::vector<std::string> told_;
};

TEST_F(LiveRosVehicleTest, TakesStampsThatAgreeWithTheTimesOfArrival) {
  for (int i = 0; i <= 5; ++i) TakeFix(kNow + i + 0.25, kNow + i);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kClockUnknown), 3u);
  ASSERT_EQ(Of<GnssFix>().size(), 3u);
  EXPECT_EQ(Of<GnssFix>()[0].time_s, kNow + 3);
  // A stamp of its own accord is on another clock.
  TakeFix(kNow + 6.25, 17);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kOtherClock), 1u);
  EXPECT_EQ(Of<GnssFix>().size(), 3u);
}

TEST_F(LiveRosVehicleTest, TakesTheTimesOfArrivalWhereAnyStampIsOnAnotherClock) {
  for (int i = 0; i <= 4; ++i) {
    TakeFix(kNow + i + 0.25, kNow + i);
    TakeImu(kNow + i + 0.5, 100 + i);  // simulation time
  }
  EXPECT_THAT(told_, Contains(HasSubstr("the times of arrival count")));
  ASSERT_EQ(Of<GnssFix>().size(), 2u);
  EXPECT_EQ(Of<GnssFix>()[0].time_s, kNow + 3.25);
  EXPECT_EQ(Of<HeadingSample>().back().time_s, kNow + 4.5);
}

TEST_F(LiveRosVehicleTest, GivesUpStampsThatGoAstrayForGood) {
  for (int i = 0; i <= 4; ++i) TakeFix(kNow + i, kNow + i);
  for (int i = 5; i < 16; ++i) TakeFix(kNow + i, kNow + i + 7200);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kOtherClock), 9u);
  EXPECT_EQ(Of<GnssFix>().back().time_s, kNow + 15);
}

TEST_F(LiveRosVehicleTest, PrefersTheBetterTopicAndTakesTheOtherOnceItIsSilent) {
  TakeFix(kNow - 3, kNow - 3);  // begins the clock
  Take("/odom", "geometry_msgs/msg/QuaternionStamped", Imu(kNow, 1.0, "base_link"), kNow);
  TakeImu(kNow + 0.1, kNow);
  Take("/odom", "geometry_msgs/msg/QuaternionStamped", Imu(kNow, 1.0, "base_link"), kNow + 0.2);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kOtherTopic), 1u);
  EXPECT_EQ(Of<HeadingSample>().size(), 2u);
  Take("/odom", "geometry_msgs/msg/QuaternionStamped", Imu(kNow + 4, 1.0, "base_link"), kNow + 4);
  EXPECT_EQ(Of<HeadingSample>().size(), 3u);
  EXPECT_EQ(told_.back(), "headings from /odom");
}

TEST_F(LiveRosVehicleTest, TakesOdometryUntilThereArePositionsOnTheEarth) {
  const auto take_odometry = [&](double arrival_s) {
    Take("/odom", "nav_msgs/msg/Odometry",
         Odometry(static_cast<std::int32_t>(arrival_s), 1.0, 2.0, 0.0), arrival_s);
  };
  take_odometry(kNow - 3);  // begins the clock
  take_odometry(kNow);
  ASSERT_EQ(Of<GnssFix>().size(), 1u);
  EXPECT_NEAR(Of<GnssFix>()[0].latitude_deg, 45.0, 1e-4);
  TakeFix(kNow + 1, kNow + 1);
  EXPECT_EQ(Of<GnssFix>().back().latitude_deg, 63.4);
  // A receiver that falls silent does not throw the boat to another place.
  take_odometry(kNow + 20);
  EXPECT_EQ(Of<GnssFix>().size(), 2u);
  EXPECT_EQ(Of<HeadingSample>().size(), 2u);
}

TEST_F(LiveRosVehicleTest, JoinsOneTopicEachSide) {
  TakeThrust("left", 0.0, kNow - 3);  // begins the clock
  TakeThrust("left", 0.5, kNow);
  TakeThrust("right", -0.25, kNow + 0.125);
  TakeThrust("left", 1.0, kNow + 0.5);
  TakeThrust("right", 1.0, kNow + 0.625);
  const auto commands = Of<ThrusterSample>();
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[0].time_s, kNow + 0.125);
  EXPECT_EQ(commands[0].port_us, 1700.0);  // 1500 + 400 share
  EXPECT_EQ(commands[0].starboard_us, 1400.0);
  EXPECT_EQ(commands[1].port_us, 1900.0);
  EXPECT_EQ(commands[1].starboard_us, 1400.0);
}

TEST_F(LiveRosVehicleTest, RefusesThrustsInNewtonsWithoutAMapping) {
  TakeThrust("left", 0.0, kNow - 3);
  TakeThrust("left", 250.0, kNow);
  TakeThrust("left", 0.5, kNow + 1);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kNotShares), 2u);
  EXPECT_THAT(told_, Contains(HasSubstr("/thrusters/left/thrust holds 250.0")));
}

TEST_F(LiveRosVehicleTest, TakesTheChannelsOfOutputsThatItIsTold) {
  SourceOptions options;
  options.port_channel = 2;
  Make(options);
  const auto take = [&](double arrival_s, const std::vector<std::uint16_t>& channels) {
    Take("/rc/out", "mavros_msgs/msg/RCOut", RcOut(kNow, channels), arrival_s);
  };
  take(kNow - 0.5, {1100, 1200, 1300});
  take(kNow + 0.5, {1100, 1200, 1300});  // before the clock is known
  EXPECT_TRUE(Of<ThrusterSample>().empty());
  Take("/rc/out", "mavros_msgs/msg/RCOut", RcOut(kNow + 3, {1100, 1200, 1300}), kNow + 3);
  ASSERT_EQ(Of<ThrusterSample>().size(), 1u);
  EXPECT_EQ(Of<ThrusterSample>()[0].port_us, 1200.0);
  EXPECT_EQ(Of<ThrusterSample>()[0].starboard_us, 1300.0);
  Take("/rc/out", "mavros_msgs/msg/RCOut", RcOut(kNow + 4, {1100}), kNow + 4);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kUnreadable), 1u);
}

TEST_F(LiveRosVehicleTest, CountsWhatItCannotRead) {
  TakeFix(kNow, kNow);
  Take("/fix", "sensor_msgs/msg/NavSatFix", {0, 1, 0, 0, 1, 2, 3}, kNow + 1);
  Take("/fix", "sensor_msgs/msg/NavSatFix", {}, kNow + 1);
  Take("/fix", "sensor_msgs/msg/NavSatFix", NavSatFix(kNow, -1), kNow + 2);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kUnreadable), 2u);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kWithoutFix), 1u);
}

TEST_F(LiveRosVehicleTest, TakesTheChannelsThatAreChosenAlone) {
  vehicle_ = std::make_unique<LiveRosVehicle>(
      SourceOptions{}, [this](const RawSample& sample) { samples_.push_back(sample); },
      [](const std::string&) {}, ChannelChoice{Channel::kHeading});
  for (int i = 0; i <= 4; ++i) {
    TakeFix(kNow + i, kNow + i);
    TakeImu(kNow + i, kNow + i);
  }
  EXPECT_EQ(samples_.size(), Of<HeadingSample>().size());
  EXPECT_EQ(vehicle_->Published(Channel::kHeading), 2u);
  EXPECT_EQ(vehicle_->Published(Channel::kGnss), 0u);
}

TEST_F(LiveRosVehicleTest, FollowsAMappingInNewtons) {
  SourceOptions options;
  options.mapping = std::make_shared<Mapping>(*ParseMapping(R"(
      name: "vrx"
      positions { topic: "/wamv/*fix" latitude: "latitude" longitude: "longitude" }
      headings { topic: "/wamv/*data" field: "orientation" unit: "quaternion" frame: "ENU" }
      port { topic: "/wamv/left/thrust" field: "data" unit: "N" full_forward: 250 full_reverse: -100 }
      starboard { topic: "/wamv/right/thrust" field: "data" unit: "N" full_forward: 250
                  full_reverse: -100 })"));
  Make(options);
  const auto thrust = [&](const std::string& side, double newtons, double arrival_s) {
    Take("/wamv/" + side + "/thrust", "std_msgs/msg/Float64", Cdr().Add(newtons).Bytes(),
         arrival_s);
  };
  TakeFix(kNow, 17, "/wamv/fix");  // the mapping names no stamp: its time is that of arrival
  TakeImu(kNow, 17, "/wamv/data");
  thrust("left", 125.0, kNow);
  thrust("right", -100.0, kNow + 1);
  thrust("left", 125.0, kNow + 2);
  Take("/wamv/fix", "sensor_msgs/msg/NavSatFix", {0, 1, 0, 0}, kNow + 2);
  ASSERT_EQ(Of<GnssFix>().size(), 1u);
  EXPECT_EQ(Of<GnssFix>()[0].time_s, kNow);
  EXPECT_NEAR(Of<HeadingSample>().at(0).heading_deg, 90.0, 1e-9);  // yaw 0 is east
  ASSERT_EQ(Of<ThrusterSample>().size(), 1u);
  EXPECT_EQ(Of<ThrusterSample>()[0].time_s, kNow + 1);
  EXPECT_EQ(Of<ThrusterSample>()[0].port_us, 1700.0);
  EXPECT_EQ(Of<ThrusterSample>()[0].starboard_us, 1100.0);
  EXPECT_EQ(vehicle_->Rejected(RosReject::kNotMapped), 1u);
}

}  // namespace
}  // namespace telltale
