#include "telltale/client/recording/rosbag1/rosbag1.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/compression.hpp"
#include "support/little_endian.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/load_recording.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;

std::string BagDouble(double value) {
  return LittleEndian(std::bit_cast<std::uint64_t>(value));
}

std::string BagFloat(float value) {
  return LittleEndian(std::bit_cast<std::uint32_t>(value));
}

/// As the ROS wiki's "Bags/Format/2.0" and the generated message serialisers lay bytes out.
std::string BagField(const std::string& name, const std::string& value) {
  return WithLength(name + '=' + value);
}

std::string BagRecord(char operation, const std::string& fields, const std::string& data) {
  return WithLength(BagField("op", std::string(1, operation)) + fields) + WithLength(data);
}

std::string BagConnection(std::uint32_t id, const std::string& topic, const std::string& type) {
  return BagRecord(7, BagField("conn", LittleEndian(id)) + BagField("topic", topic),
                   BagField("topic", topic) + BagField("type", type) + BagField("md5sum", "*") +
                       BagField("message_definition", ""));
}

std::string BagMessage(std::uint32_t connection, std::uint32_t seconds, const std::string& data) {
  return BagRecord(
      2,
      BagField("conn", LittleEndian(connection)) +
          BagField("time", LittleEndian(seconds) + LittleEndian(std::uint32_t{500000000})),
      data);
}

std::string BagHeader(std::uint32_t seconds, const std::string& frame) {
  return LittleEndian(std::uint32_t{7}) + LittleEndian(seconds) +
         LittleEndian(std::uint32_t{250000000}) + WithLength(frame);
}

/// A Clearpath Heron: navsat/fix, imu/data and cmd_drive.
std::string HeronRecords() {
  const std::string fix = BagHeader(100, "navsat") + std::string(1, '\0') +
                          LittleEndian(std::uint16_t{1}) + BagDouble(46.5) + BagDouble(-80.25) +
                          BagDouble(200.0) + std::string(73, '\0');
  // East-north-up and a yaw of 90 degrees: the bow points north.
  const std::string imu = BagHeader(100, "imu_link") + BagDouble(0.0) + BagDouble(0.0) +
                          BagDouble(std::sqrt(0.5)) + BagDouble(std::sqrt(0.5)) +
                          std::string(264, '\0');
  return BagConnection(0, "/navsat/fix", "sensor_msgs/NavSatFix") +
         BagConnection(1, "/imu/data", "sensor_msgs/Imu") +
         BagConnection(2, "/cmd_drive", "heron_msgs/Drive") + BagMessage(0, 100, fix) +
         BagMessage(1, 100, imu) + BagMessage(2, 100, BagFloat(0.5f) + BagFloat(-0.25f));
}

std::string BagChunk(const std::string& compression, std::size_t size, const std::string& data) {
  return BagRecord(5,
                   BagField("compression", compression) +
                       BagField("size", LittleEndian(static_cast<std::uint32_t>(size))),
                   data);
}

std::string Bag(const std::string& records) {
  return "#ROSBAG V2.0\n" + BagRecord(3, BagField("chunk_count", LittleEndian(1u)), "    ") +
         records;
}

SourceLog Parsed(const std::string& bytes, std::size_t block = 1000) {
  return ParseRosbag1({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, block,
                      {});
}

void ExpectHeron(const SourceLog& log) {
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_EQ(log.gnss[0].latitude_deg, 46.5);
  EXPECT_EQ(log.gnss[0].longitude_deg, -80.25);
  EXPECT_EQ(log.gnss[0].time_s, 100.25);  // of the header, which agrees with the recorder's clock
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_NEAR(log.heading[0].heading_deg, 0.0, 1e-12);
  ASSERT_EQ(log.thrusters.size(), 1u);
  EXPECT_EQ(log.thrusters[0].time_s, 100.5);
  EXPECT_EQ(log.thrusters[0].port_us, 1700.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1400.0);
}

TEST(Rosbag1, ReadsChunksOfEachCompressionAndNone) {
  const std::string records = HeronRecords();
  ExpectHeron(Parsed(Bag(records)));
  ExpectHeron(Parsed(Bag(BagChunk("none", records.size(), records))));
  ExpectHeron(Parsed(Bag(BagChunk("bz2", records.size(), Bz2(records)))));
  ExpectHeron(Parsed(Bag(BagChunk("lz4", records.size(), Lz4(records)))));
}

TEST(Rosbag1, BlocksChangeNothing) {
  const std::string bag = Bag(HeronRecords());
  for (const std::size_t block : {1u, 7u, 64u}) ExpectHeron(Parsed(bag, block));
}

TEST(Rosbag1, CountsWhatIsDamaged) {
  const std::string records = HeronRecords();
  std::string corrupt = Bz2(records);
  corrupt[corrupt.size() / 2] ^= 0x55;
  const SourceLog chunk =
      Parsed(Bag(BagChunk("bz2", records.size(), corrupt) +
                 BagChunk("zip", records.size(), records) + BagMessage(9, 1, "")));
  EXPECT_THAT(chunk.summary, HasSubstr("2 unreadable chunks"));
  EXPECT_THAT(chunk.summary, HasSubstr("1 messages of undefined connections"));
  EXPECT_TRUE(chunk.gnss.empty());

  const SourceLog cut = Parsed(Bag(records + BagMessage(0, 101, "0123456789").substr(0, 20)));
  ExpectHeron(cut);
  EXPECT_THAT(cut.summary, HasSubstr("20 bytes of a record cut off at the end"));
}

TEST(Rosbag1, IsToldByItsContent) {
  const TemporaryFolder folder;
  const auto file = folder.Path() / "heron";
  std::ofstream(file, std::ios::binary) << Bag(HeronRecords());
  EXPECT_EQ(FormatOf(file), LogFormat::kRosbag1);
  const auto log = ReadLog(file);
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_EQ(log->channels.Size(), 3u);

  std::ofstream(file, std::ios::binary) << Bag(BagConnection(0, "/chat", "std_msgs/String"));
  const auto lacking = LoadRecording(file);
  ASSERT_FALSE(lacking);
  EXPECT_THAT(lacking.error().reason, HasSubstr("no position"));
}

}  // namespace
}  // namespace telltale
