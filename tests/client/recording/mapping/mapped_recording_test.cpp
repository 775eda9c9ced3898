#include "telltale/client/recording/mapping/mapped_recording.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/recording/mapping/mapped_messages.hpp"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Mapping MappingOf(const std::string& text) {
  const auto mapping = ParseMapping(text, "map.textproto");
  if (!mapping) throw std::runtime_error(mapping.error().Message());
  return *mapping;
}

Mapping Shipped(const std::string& name) {
  const std::filesystem::path file =
      std::filesystem::path(TELLTALE_SOURCE_DIR) / "deploy/mappings" / (name + ".textproto");
  return MappingOf(*ReadFile(file));
}

class MappedNumbers : public MessageFields {
 public:
  explicit MappedNumbers(std::map<std::string, double, std::less<>> values)
      : values_(std::move(values)) {}
  std::optional<double> Number(std::string_view path) const override {
    const auto found = values_.find(path);
    return found == values_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<std::string, double, std::less<>> values_;
};

/// Little-endian CDR of ROS 2, aligned as OMG DDS-XTypes 7.4 says; or of ROS 1, without alignment.
class Serialised {
 public:
  explicit Serialised(CdrReader::Encoding encoding) : is_ros2_(encoding == kRos2) {
    if (is_ros2_) bytes_ = {0, 1, 0, 0};
  }
  static constexpr CdrReader::Encoding kRos2 = CdrReader::Encoding::kCdr;

  Serialised& Whole(std::uint64_t value, std::size_t size) {
    while (is_ros2_ && (bytes_.size() - 4) % size != 0) bytes_.push_back(0);
    for (std::size_t i = 0; i < size; ++i) {
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
    }
    return *this;
  }
  Serialised& Real(double value) { return Whole(std::bit_cast<std::uint64_t>(value), 8); }
  Serialised& Single(float value) { return Whole(std::bit_cast<std::uint32_t>(value), 4); }
  Serialised& Text(const std::string& text) {
    Whole(text.size() + (is_ros2_ ? 1 : 0), 4);
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    if (is_ros2_) bytes_.push_back(0);
    return *this;
  }
  Serialised& Header(std::uint32_t sec, std::uint32_t nanosec) {
    if (!is_ros2_) Whole(7, 4);
    return Whole(sec, 4).Whole(nanosec, 4).Text("frame");
  }
  const std::vector<std::uint8_t>& Bytes() const { return bytes_; }

 private:
  bool is_ros2_;
  std::vector<std::uint8_t> bytes_;
};

TEST(TopicMatches, StarsStandForAnyCharacters) {
  EXPECT_TRUE(TopicMatches("/gps/fix", "/gps/fix"));
  EXPECT_FALSE(TopicMatches("/gps/fix", "/gps/fix2"));
  EXPECT_TRUE(TopicMatches("*/rc/out", "/mavros/rc/out"));
  EXPECT_FALSE(TopicMatches("*/rc/out", "/mavros/rc/out/raw"));
  EXPECT_TRUE(TopicMatches("mavlink/*/ATTITUDE", "mavlink/1/1/ATTITUDE"));
  EXPECT_TRUE(TopicMatches("a*b*c", "aXbXbXc"));
  EXPECT_TRUE(TopicMatches("", ""));
  EXPECT_FALSE(TopicMatches("", "/x"));
  EXPECT_FALSE(TopicMatches("", "/"));
  EXPECT_TRUE(TopicMatches("mavlink/*/ATTITUDE", "/mavlink/1/1/ATTITUDE"));
  EXPECT_TRUE(TopicMatches("/gps/fix", "gps/fix"));
  EXPECT_FALSE(TopicMatches("/gps/fix", "//gps/fix"));
}

TEST(MappedRecording, ConvertsUnitsAndFrames) {
  const Mapping mapping = MappingOf(R"(
    time { field: "t" unit: "ms" }
    positions { latitude: "lat" longitude: "lon" unit: "1e-7 deg" }
    headings { field: "yaw" unit: "rad" frame: "ENU" offset_deg: 2 }
    port { field: "l" unit: "N" full_forward: 50 full_reverse: -40 }
    starboard { field: "r" unit: "percent" }
  )");
  MappedRecording recording(mapping);
  recording.Take("", 9.0,
                 MappedNumbers({{"t", 1500.0},
                                {"lat", 634000000.0},
                                {"lon", 104000000.0},
                                {"yaw", M_PI / 6},
                                {"l", 25.0},
                                {"r", -50.0}}));
  recording.Take("", 9.0, MappedNumbers({{"t", 1600.0}, {"l", -40.0}, {"r", 100.0}}));
  const SourceLog log = std::move(recording).Finish("rows");
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_DOUBLE_EQ(log.gnss[0].time_s, 1.5);
  EXPECT_NEAR(log.gnss[0].latitude_deg, 63.4, 1e-12);
  EXPECT_NEAR(log.gnss[0].longitude_deg, 10.4, 1e-12);
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_NEAR(log.heading[0].heading_deg, 62.0, 1e-12);  // 90 - 30 + 2
  ASSERT_EQ(log.thrusters.size(), 2u);
  EXPECT_DOUBLE_EQ(log.thrusters[0].port_us, 1700.0);       // 25 N of 50 N ahead
  EXPECT_DOUBLE_EQ(log.thrusters[0].starboard_us, 1300.0);  // half astern
  EXPECT_DOUBLE_EQ(log.thrusters[1].port_us, 1100.0);       // full astern
  EXPECT_DOUBLE_EQ(log.thrusters[1].starboard_us, 1900.0);
  EXPECT_THAT(log.summary, HasSubstr("1 rows without a position"));
}

TEST(MappedRecording, ThinsWhatOutgrowsItsMemoryAndSaysSo) {
  const Mapping mapping = MappingOf(R"(
    time { field: "t" unit: "ms" }
    positions { latitude: "lat" longitude: "lon" unit: "deg" }
    headings { field: "yaw" unit: "deg" }
    port { field: "l" unit: "us" }
    starboard { field: "r" unit: "us" }
  )");
  MappedRecording recording(mapping, 60'000);
  for (int ms = 0; ms < 60'000; ms += 2) {
    recording.Take("", 9.0, MappedNumbers({{"t", ms}, {"yaw", 30.0}}));
  }
  const SourceLog log = std::move(recording).Finish("rows");
  EXPECT_EQ(log.heading.size(), 60u * 50u);
  EXPECT_THAT(log.summary, HasSubstr("thinned by whole samples to 50 Hz"));
}

TEST(MappedRecording, CountsHeldValuesOnceAndLeavesOutWhatIsNoFix) {
  const Mapping mapping = MappingOf(R"(
    time { field: "t" }
    positions { latitude: "lat" longitude: "lon" held: true }
    headings { field: "h" held: true }
    port { field: "l" } starboard { field: "r" }
  )");
  MappedRecording recording(mapping);
  const auto row = [&](double t, double lat, double h) {
    recording.Take(
        "", 0.0,
        MappedNumbers(
            {{"t", t}, {"lat", lat}, {"lon", lat}, {"h", h}, {"l", 1500.0}, {"r", 1500.0}}));
  };
  row(0.0, 0.0, 10.0);
  row(0.1, 1.0, 10.0);
  row(0.2, 1.0, 20.0);
  row(0.3, 2.0, 20.0);
  const SourceLog log = std::move(recording).Finish("rows");
  ASSERT_EQ(log.gnss.size(), 2u);
  EXPECT_EQ(log.gnss[1].time_s, 0.3);
  ASSERT_EQ(log.heading.size(), 2u);
  EXPECT_EQ(log.heading[1].time_s, 0.2);
  EXPECT_EQ(log.thrusters.size(), 4u);
  EXPECT_THAT(log.summary, HasSubstr("1 positions without a fix"));
}

TEST(MappedRecording, TakesAllChannelsFromTheBoatThatSpeaksFirst) {
  const Mapping mapping = Shipped("mavros");
  MappedRecording recording(mapping);
  const auto take = [&](const std::string& topic, double time_s,
                        std::map<std::string, double, std::less<>> values) {
    recording.Take(topic, time_s, MappedNumbers(std::move(values)));
  };
  take("/boat1/mavros/global_position/raw/fix", 1.0, {{"latitude", 63.4}, {"longitude", 10.4}});
  for (const char* boat : {"/boat2", "/boat1"}) {
    const std::string mavros = std::string(boat) + "/mavros";
    const double own = mavros.starts_with("/boat1") ? 1.0 : 2.0;
    take(mavros + "/global_position/compass_hdg", 1.0, {{"data", own}});
    take(mavros + "/rc/out", 1.0, {{"channels[0]", 1500 + own}, {"channels[2]", 1600 + own}});
  }
  const SourceLog log = std::move(recording).Finish("messages");
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_EQ(log.heading[0].heading_deg, 1.0);
  ASSERT_EQ(log.thrusters.size(), 1u);
  EXPECT_EQ(log.thrusters[0].port_us, 1501.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1601.0);
  EXPECT_THAT(log.summary, HasSubstr("left out, though the mapping matches: /boat2/mavros/rc/out"));
}

TEST(MappedRecording, TakesOneOfTwoBoatsWhoseTopicsBeginWithASlash) {
  const Mapping mapping = MappingOf(R"(
    positions { topic: "boats/*/fix" latitude: "lat" longitude: "lon" }
    headings { topic: "/boats/*/heading" field: "deg" }
    port { topic: "boats/*/left" field: "us" unit: "us" }
    starboard { topic: "boats/*/right" field: "us" unit: "us" }
  )");
  MappedRecording recording(mapping);
  const auto speak = [&](const std::string& boat, double latitude_deg) {
    recording.Take(boat + "/fix", 9.0, MappedNumbers({{"lat", latitude_deg}, {"lon", 10.4}}));
    recording.Take(boat + "/heading", 9.0, MappedNumbers({{"deg", latitude_deg}}));
  };
  speak("/boats/a", 63.0);
  speak("/boats/b", 64.0);
  speak("boats/a/", 65.0);  // another name
  const SourceLog log = std::move(recording).Finish("messages");
  ASSERT_EQ(log.gnss.size(), 1u);
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_EQ(log.gnss[0].latitude_deg, 63.0);
  EXPECT_EQ(log.heading[0].heading_deg, 63.0);
}

TEST(MappedRecording, TakesTopicsThatStandBelowTheNamespaceOfOthers) {
  const Mapping mapping = MappingOf(
      "positions { topic: \"*/fix\" latitude: \"latitude\" longitude: \"longitude\" }"
      "headings { topic: \"*/heading\" field: \"data\" }"
      "port { topic: \"*/out\" field: \"left\" } starboard { topic: \"*/out\" field: \"right\" }");
  MappedRecording recording(mapping);
  const auto take = [&](const std::string& topic,
                        std::map<std::string, double, std::less<>> values) {
    recording.Take(topic, 1.0, MappedNumbers(std::move(values)));
  };
  take("/boat1/sensors/gps/fix", {{"latitude", 63.4}, {"longitude", 10.4}});
  take("/boat10/sensors/heading", {{"data", 2.0}});
  take("/boat1/sensors/heading", {{"data", 1.0}});
  take("/boat1/out", {{"left", 1501.0}, {"right", 1601.0}});
  const SourceLog log = std::move(recording).Finish("messages");
  ASSERT_TRUE(log.Lacks().empty()) << log.summary;
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_EQ(log.heading[0].heading_deg, 1.0);
}

TEST(MappingFile, SaysWhatIsWrongAndWhatIsAllowed) {
  const auto said = [](const std::string& text) {
    const auto mapping = ParseMapping(text, "map.textproto");
    return mapping ? std::string() : mapping.error().Message();
  };
  const std::string positions = "positions { latitude: \"a\" longitude: \"b\" }\n";
  const std::string headings = "headings { field: \"h\" }\n";
  const std::string sides = "port { field: \"l\" } starboard { field: \"r\" }\n";
  EXPECT_EQ(said(positions + headings + sides), "");
  EXPECT_THAT(said(headings + sides), HasSubstr("positions"));
  EXPECT_THAT(said(positions + "headings { field: \"h\" unit: \"grad\" }\n" + sides),
              AllOf(HasSubstr("map.textproto:2"), HasSubstr("headings.unit"), HasSubstr("grad"),
                    HasSubstr("deg, rad")));
  EXPECT_THAT(
      said(positions + headings + "port { field: \"l\" unit: \"N\" } starboard { field: \"r\" }"),
      HasSubstr("port.full_forward"));
  EXPECT_THAT(said(positions + headings +
                   "port { field: \"l\" unit: \"share\" full_forward: 1 full_reverse: 1 } "
                   "starboard { field: \"r\" }"),
              HasSubstr("of the other sign"));
  EXPECT_THAT(said("positions { north: \"n\" }\n" + headings + sides), HasSubstr("positions.east"));
  EXPECT_THAT(said("positions { north: \"n\" east: \"e\" unit: \"rad\" }\n" + headings + sides),
              AllOf(HasSubstr("positions.unit"), HasSubstr("in metres")));
  EXPECT_THAT(said("nonsense { }"), HasSubstr("nonsense"));
}

/// The same boat at heading 60 degrees, in the messages that each shipped mapping names.
TEST(ShippedMappings, FindTheChannelsOfTheirRecordings) {
  constexpr auto kRos1 = CdrReader::Encoding::kRos1;
  constexpr auto kRos2 = CdrReader::Encoding::kCdr;
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  const auto take_fix = [](MappedMessages& messages, const char* topic,
                           CdrReader::Encoding encoding) {
    Serialised fix(encoding);
    fix.Header(100, 0).Whole(0, 1).Whole(1, 2).Real(63.4).Real(10.4).Real(0.0);
    messages.OpenRos({topic, "sensor_msgs/msg/NavSatFix", ""}, encoding)(100 * kSecondNs,
                                                                         fix.Bytes());
  };
  const auto take_orientation = [](MappedMessages& messages, const char* topic, const char* type,
                                   CdrReader::Encoding encoding) {
    Serialised message(encoding);
    message.Header(100, 0);
    if (std::string_view(type).find("GeoPose") != std::string_view::npos) {
      message.Real(63.4).Real(10.4).Real(0.0);
    }
    const double yaw = M_PI / 6;  // from east, anticlockwise
    message.Real(0.0).Real(0.0).Real(std::sin(yaw / 2)).Real(std::cos(yaw / 2));
    messages.OpenRos({topic, type, ""}, encoding)(100 * kSecondNs, message.Bytes());
  };
  const auto take_outputs = [](MappedMessages& messages) {
    Serialised outputs(kRos2);
    outputs.Header(100, 0).Whole(4, 4);
    for (const std::uint64_t us : {1700, 1500, 1300, 1500}) outputs.Whole(us, 2);
    messages.OpenRos({"/mavros/rc/out", "mavros_msgs/msg/RCOut", ""}, kRos2)(100 * kSecondNs,
                                                                             outputs.Bytes());
  };
  const auto take_number = [](MappedMessages& messages, const char* topic, double value) {
    messages.OpenRos({topic, "std_msgs/msg/Float64", ""}, kRos2)(
        100 * kSecondNs, Serialised(kRos2).Real(value).Bytes());
  };
  const auto expect_boat = [](const SourceLog& log) {
    EXPECT_TRUE(log.Lacks().empty()) << log.summary;
    ASSERT_EQ(log.gnss.size(), 1u);
    EXPECT_NEAR(log.gnss[0].latitude_deg, 63.4, 1e-9);
    EXPECT_NEAR(log.heading.at(0).heading_deg, 60.0, 1e-9);
    EXPECT_NEAR(log.thrusters.at(0).port_us, 1700.0, 1e-4);
    EXPECT_NEAR(log.thrusters.at(0).starboard_us, 1300.0, 1e-4);
  };
  const auto gather = [](const char* name, auto take) {
    MappedMessages messages(std::make_shared<const Mapping>(Shipped(name)));
    take(messages);
    return std::move(messages).Finish();
  };

  expect_boat(gather("vrx", [&](MappedMessages& messages) {
    take_fix(messages, "/wamv/sensors/gps/gps/fix", kRos2);
    take_orientation(messages, "/wamv/sensors/imu/imu/data", "sensor_msgs/msg/Imu", kRos2);
    take_number(messages, "/wamv/thrusters/left/thrust", 500.0);
    take_number(messages, "/wamv/thrusters/right/thrust", -500.0);
  }));
  expect_boat(gather("mavros", [&](MappedMessages& messages) {
    take_fix(messages, "/mavros/global_position/raw/fix", kRos2);
    take_number(messages, "/mavros/global_position/compass_hdg", 60.0);
    take_outputs(messages);
  }));
  expect_boat(gather("ardupilot", [&](MappedMessages& messages) {
    take_fix(messages, "/ap/v1/navsat", kRos2);
    take_orientation(messages, "/ap/v1/geopose/filtered", "geographic_msgs/msg/GeoPoseStamped",
                     kRos2);
    take_outputs(messages);
  }));
  expect_boat(gather("heron", [&](MappedMessages& messages) {
    take_fix(messages, "/navsat/fix", kRos1);
    take_orientation(messages, "/imu/data", "sensor_msgs/msg/Imu", kRos1);
    Serialised drive(kRos1);
    drive.Single(0.5F).Single(-0.5F);
    messages.OpenRos({"/cmd_drive", "heron_msgs/msg/Drive", ""}, kRos1)(100 * kSecondNs,
                                                                        drive.Bytes());
  }));
  for (const std::string slash : {"", "/"}) {  // its recorders differ in this
    expect_boat(gather("blueos", [&](MappedMessages& messages) {
      const auto take = [&](const char* topic, const std::string& json) {
        messages.OpenJson(slash + topic)(
            0, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()});
      };
      take("mavlink/1/1/GPS_RAW_INT",
           R"({"message":{"time_usec":100000000,"lat":634000000,"lon":104000000}})");
      take("mavlink/1/1/ATTITUDE",
           R"({"message":{"time_boot_ms":100000,"yaw":1.0471975511965976}})");
      take("mavlink/1/1/SERVO_OUTPUT_RAW",
           R"({"message":{"time_usec":100000000,"servo1_raw":1700,"servo3_raw":1300}})");
    }));
  }
}

TEST(RosMessageType, ReadsFieldsOfADefinitionOfItsOwn) {
  const std::string definition =
      "# a boat\n"
      "uint8 KIND=3\n"
      "string<=10 name\n"
      "float32[3] weights  # of three\n"
      "Side[] sides\n"
      "bool is_armed\n"
      "================================================================================\n"
      "MSG: boat_msgs/Side\n"
      "int16 pulse 1500\n"
      "float64 thrust\n";
  const auto type = RosMessageType::Of("boat_msgs/msg/Boat", definition);
  ASSERT_TRUE(type);
  Serialised boat(CdrReader::Encoding::kCdr);
  boat.Text("abc").Single(1.0F).Single(2.0F).Single(4.0F).Whole(2, 4);
  boat.Whole(1600, 2).Real(0.25).Whole(1400, 2).Real(-0.5).Whole(1, 1);
  const RosFields fields(*type, boat.Bytes(), CdrReader::Encoding::kCdr);
  EXPECT_EQ(fields.Number("weights[2]"), 4.0);
  EXPECT_EQ(fields.Number("sides[0].pulse"), 1600.0);
  EXPECT_EQ(fields.Number("sides[1].thrust"), -0.5);
  EXPECT_EQ(fields.Number("is_armed"), 1.0);
  for (const char* path : {"sides[2].pulse", "sides.pulse", "weights", "name", "KIND", "nothing",
                           "", "sides[", "sides[x].pulse", "weights[2].x"}) {
    EXPECT_EQ(fields.Number(path), std::nullopt) << path;
  }
  const RosFields cut(*type, std::span(boat.Bytes()).first(30), CdrReader::Encoding::kCdr);
  EXPECT_EQ(cut.Number("sides[1].thrust"), std::nullopt);
  EXPECT_EQ(RosMessageType::Of("boat_msgs/msg/Unknown", ""), std::nullopt);
}

}  // namespace
}  // namespace telltale
