#include "telltale/client/recording/ros/idl_definition.hpp"

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "support/ros_messages.hpp"
#include "telltale/client/recording/ros/message_definition.hpp"

namespace telltale {
namespace {

// As rosidl_adapter of ROS 2 writes a .msg with a header, a constant, an array of fixed length, a
// bounded sequence, a comment and a default; joined as MCAP's ros2idl joins files.
constexpr const char* kIdl =
    R"(================================================================================
IDL: boat_msgs/msg/Drive
// generated from rosidl_adapter/resource/msg.idl.em
// with input from boat_msgs/msg/Drive.msg
#include "std_msgs/msg/Header.idl"

module boat_msgs {
  module msg {
    typedef double double__3[3];
    module Drive_Constants {
      const uint8 MANUAL = 1;
      @verbatim (language="comment", text="of } and ) it \"says\" nothing")
      const string NAME = "a; b";
    };
    @verbatim (language="comment", text=
      "What the thrusters are told." "\n"
      "left first")
    struct Drive {
      std_msgs::msg::Header header;

      @default (value=1)
      octet mode;

      @unit (value="N")
      double__3 bias;

      sequence<boat_msgs::msg::Thruster, 4> thrusters;
      unsigned long long count;
      string<16> name; /* bounded */
      double left, right;
    };
  };
};
================================================================================
IDL: boat_msgs/msg/Thruster
module boat_msgs {
  module msg {
    struct Thruster {
      float share;
      int16 rpm;
    };
  };
};
)";

TEST(RosDefinitionOfIdl, IsThatOfTheSameMessage) {
  EXPECT_EQ(RosDefinitionOfIdl(kIdl),
            "MSG: boat_msgs/Drive\n"
            "std_msgs/Header header\n"
            "uint8 mode\n"
            "float64[3] bias\n"
            "boat_msgs/Thruster[] thrusters\n"
            "uint64 count\n"
            "string name\n"
            "float64 left\n"
            "float64 right\n"
            "===\n"
            "MSG: boat_msgs/Thruster\n"
            "float32 share\n"
            "int16 rpm\n"
            "===\n");
}

TEST(RosDefinitionOfIdl, OpensMessages) {
  const auto type = RosMessageType::Of("boat_msgs/msg/Drive", RosDefinitionOfIdl(kIdl));
  ASSERT_TRUE(type);
  Cdr cdr;
  cdr.AddHeader(7).Add(std::uint8_t{1}).Add(0.25).Add(0.5).Add(0.75);
  cdr.Add(std::uint32_t{1}).Add(std::bit_cast<std::uint32_t>(0.5F)).Add(std::int16_t{-900});
  cdr.Add(std::uint64_t{12}).AddText("boat").Add(1.5).Add(-1.5);
  const RosFields fields(*type, cdr.Bytes(), CdrReader::Encoding::kCdr);
  EXPECT_EQ(fields.Number("header.stamp.sec"), 7.0);
  EXPECT_EQ(fields.Number("bias[2]"), 0.75);
  EXPECT_EQ(fields.Number("thrusters[0].share"), 0.5);
  EXPECT_EQ(fields.Number("thrusters[0].rpm"), -900.0);
  EXPECT_EQ(fields.Number("count"), 12.0);
  EXPECT_EQ(fields.Number("right"), -1.5);
}

TEST(RosDefinitionOfIdl, EndsWithAnyText) {
  const std::string idl = kIdl;
  for (std::size_t length = 0; length < idl.size(); ++length) {
    RosDefinitionOfIdl(std::string_view(idl).substr(0, length));
  }
  std::string nested;
  for (int i = 0; i < 10000; ++i) nested += "sequence<";
  RosDefinitionOfIdl("module a { struct B { " + nested);
}

}  // namespace
}  // namespace telltale
