#include "telltale/client/recording/mavlink/mavlink_json.hpp"

#include <cstdint>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

class MavlinkJsonTest : public testing::Test {
 protected:
  bool Take(const std::string& message, const std::string& header = R"({"system_id": 7})") {
    const std::string json = R"({"header": )" + header + R"(, "message": )" + message + '}';
    return json_.Take({reinterpret_cast<const std::uint8_t*>(json.data()), json.size()},
                      recording_);
  }
  SourceLog Finished() { return std::move(recording_).Finish({}); }

  MavlinkJson json_;
  MavlinkRecording recording_;
};

// The fields and the spelling of a BlueOS recorder: parameters as arrays of characters,
// enumerations as objects.
TEST_F(MavlinkJsonTest, TakesThreeChannels) {
  EXPECT_TRUE(Take(R"({"type": "PARAM_VALUE", "param_id": ["S","E","R","V","O","1","_","F","U","N",
      "C","T","I","O","N","\u0000"], "param_value": 73.0})"));
  EXPECT_TRUE(
      Take(R"({"type": "PARAM_VALUE", "param_id": "SERVO16_FUNCTION", "param_value": 74})"));
  EXPECT_TRUE(Take(R"({"type": "GPS_RAW_INT", "time_usec": 2000000, "lat": 634000000,
      "lon": -104000000, "fix_type": {"type": "GPS_FIX_TYPE_3D_FIX"}})"));
  EXPECT_TRUE(Take(R"({"type": "ATTITUDE", "time_boot_ms": 2500, "yaw": 0.5})"));
  EXPECT_TRUE(Take(R"({"type": "SERVO_OUTPUT_RAW", "time_usec": 4000000, "port": 0,
      "servo1_raw": 1600, "servo16_raw": 1400, "servo17_raw": 1, "servox_raw": 2})"));
  const SourceLog log = Finished();
  ASSERT_TRUE(log.Lacks().empty()) << log.summary;
  EXPECT_EQ(log.gnss.at(0).time_s, 2.0);
  EXPECT_DOUBLE_EQ(log.gnss.at(0).latitude_deg, 63.4);
  EXPECT_DOUBLE_EQ(log.gnss.at(0).longitude_deg, -10.4);
  EXPECT_FLOAT_EQ(static_cast<float>(log.heading.at(0).heading_deg), 28.647890F);
  EXPECT_EQ(log.thrusters.at(0).port_us, 1600.0);
  EXPECT_EQ(log.thrusters.at(0).starboard_us, 1400.0);
  EXPECT_THAT(log.summary, testing::HasSubstr("system 7"));
}

// Newer recorders write the name as the codes of its characters.
TEST_F(MavlinkJsonTest, TakesTheNameOfAParameterAsCodes) {
  EXPECT_TRUE(Take(R"({"type": "PARAM_VALUE", "param_id": [83,69,82,86,79,49,95,70,85,78,67,84,73,
      79,78,0], "param_value": 73})"));
  EXPECT_TRUE(Take(R"({"type": "PARAM_VALUE", "param_id": "SERVO3_FUNCTION", "param_value": 74})"));
  EXPECT_TRUE(Take(R"({"type": "SERVO_OUTPUT_RAW", "time_usec": 4000000, "port": 0,
      "servo1_raw": 1600, "servo3_raw": 1400})"));
  EXPECT_EQ(Finished().thrusters.at(0).port_us, 1600.0);
}

TEST_F(MavlinkJsonTest, TakesNoFixWithoutOne) {
  for (const char* fix :
       {"2", R"("GPS_FIX_TYPE_2D_FIX")", R"({"type": "GPS_FIX_TYPE_NO_GPS"})", "null"}) {
    EXPECT_TRUE(Take(R"({"type": "GPS_RAW_INT", "time_usec": 1, "lat": 1, "lon": 1, "fix_type": )" +
                     std::string(fix) + '}'));
  }
  EXPECT_TRUE(Finished().gnss.empty());
}

TEST_F(MavlinkJsonTest, LeavesHeadingOutThatTheAutopilotDoesNotKnow) {
  for (const char* heading : {"65535", "9000"}) {
    EXPECT_TRUE(Take(R"({"type": "GLOBAL_POSITION_INT", "time_boot_ms": 1000, "lat": 1, "lon": 1,
        "hdg": )" + std::string(heading) +
                     '}'));
  }
  const SourceLog log = Finished();
  EXPECT_EQ(log.gnss.size(), 2u);
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_DOUBLE_EQ(log.heading[0].heading_deg, 90.0);
}

TEST_F(MavlinkJsonTest, RefusesWhatIsNotAsItShouldBe) {
  EXPECT_FALSE(Take(R"({"type": "ATTITUDE", "time_boot_ms": 2500})")) << "without its yaw";
  EXPECT_FALSE(Take(R"({"type": "ATTITUDE", "time_boot_ms": -1, "yaw": 0})"));
  EXPECT_FALSE(Take(R"({"type": "ATTITUDE", "time_boot_ms": 4294967296, "yaw": 0})"));
  EXPECT_FALSE(Take(R"({"type": "ATTITUDE", "time_boot_ms": "1", "yaw": 0})"));
  EXPECT_FALSE(Take(R"({"time_boot_ms": 1, "yaw": 0})"));
  EXPECT_FALSE(Take(R"({"type": "ATTITUDE", "time_boot_ms": 1, "yaw": 0})", "{}"));
  EXPECT_FALSE(Take(R"({"type": "ATTITUDE", "time_boot_ms": 1, "yaw": )")) << "cut off";
  EXPECT_FALSE(json_.Take({}, recording_));
  EXPECT_TRUE(Take(R"({"type": "VFR_HUD"})")) << "of no use";
  EXPECT_TRUE(Finished().heading.empty());
}

}  // namespace
}  // namespace telltale
