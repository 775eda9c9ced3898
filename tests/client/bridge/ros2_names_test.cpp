#include "telltale/client/bridge/ros2_names.hpp"

#include <gtest/gtest.h>

#include "telltale/client/bridge/ros2_bridge.hpp"

namespace telltale {
namespace {

// Names on DDS: ROS 2 design, "Topic and Service name mapping to DDS".
TEST(Ros2Names, AreThoseOfDdsWithoutWhatRos2PutsAround) {
  EXPECT_EQ(RosTopicOfDds("rt/boat1/fix"), "/boat1/fix");
  EXPECT_FALSE(RosTopicOfDds("telltale/telemetry/gnss"));
  EXPECT_FALSE(RosTopicOfDds("rq/boat1/resetRequest"));
  EXPECT_EQ(RosTypeOfDds("sensor_msgs::msg::dds_::NavSatFix_"), "sensor_msgs/msg/NavSatFix");
  EXPECT_FALSE(RosTypeOfDds("telltale::wire::GnssFix"));
  EXPECT_FALSE(RosTypeOfDds("std_srvs::srv::dds_::Empty_Request_"));
}

TEST(Ros2Names, FindTheVehicleInATopic) {
  EXPECT_EQ(VehicleInTopic("/{vehicle}", "/boat1/mavros/rc/out"), "boat1");
  EXPECT_EQ(VehicleInTopic("/fleet/{vehicle}", "/fleet/a/fix"), "a");
  EXPECT_FALSE(VehicleInTopic("/fleet/{vehicle}", "/fleet/fix"));
  EXPECT_FALSE(VehicleInTopic("/fleet/{vehicle}", "/other/a/fix"));
  EXPECT_EQ(VehicleInTopic("/{vehicle}/mavros", "/a/mavros/rc/out"), "a");
  EXPECT_FALSE(VehicleInTopic("/{vehicle}/mavros", "/a/mavros2/rc/out"));
  EXPECT_EQ(VehicleInTopic("/ap/v{vehicle}", "/ap/v7/navsat"), "7");
  EXPECT_EQ(VehicleInTopic("/{vehicle}_base", "/usv_base/fix"), "usv");
  EXPECT_FALSE(VehicleInTopic("/{vehicle}_base", "/_base/fix"));
  EXPECT_EQ(VehicleInTopic("/", "/fix"), "");
  EXPECT_EQ(VehicleInTopic("/wamv", "/wamv/sensors/gps/fix"), "");
  EXPECT_FALSE(VehicleInTopic("/wamv", "/wamv2/sensors/gps/fix"));
}

TEST(Ros2Names, OfVehiclesMayStandInATopic) {
  EXPECT_EQ(RosNameOf("boat-1"), "boat_1");
  EXPECT_EQ(RosNameOf("made-up.1"), "made_up_1");
  EXPECT_EQ(RosNameOf("007"), "vehicle_007");
}

TEST(Ros2Names, FaultsNameWhatIsAllowed) {
  for (const char* sound :
       {"/", "/{vehicle}", "/fleet/{vehicle}/mavros", "/ap/v{vehicle}", "/a_1"}) {
    EXPECT_FALSE(NamespaceFault(sound)) << sound;
  }
  for (const char* wrong :
       {"", "fleet", "/fleet/", "//a", "/a b", "/{boat}", "/{vehicle}/{vehicle}"}) {
    EXPECT_TRUE(NamespaceFault(wrong)) << wrong;
  }
}

TEST(Ros2BridgeOptions, NeedAVehicleInBothPatternsOrInNeither) {
  const auto fault = [](const std::string& name_space, const std::string& id) {
    return Ros2BridgeOptions{
        .name_space = name_space, .vehicle_id = id, .source = {}, .channels = {}}
        .Fault();
  };
  EXPECT_FALSE(fault("", "{vehicle}"));
  EXPECT_FALSE(fault("", "boat-1"));  // whose all topics then are
  EXPECT_FALSE(fault("/fleet/{vehicle}", "fleet-{vehicle}"));
  EXPECT_TRUE(fault("/fleet/{vehicle}", "boat-1"));
  EXPECT_TRUE(fault("/fleet", "{vehicle}"));
  EXPECT_TRUE(fault("", "{vehicle} 1"));
}

}  // namespace
}  // namespace telltale
