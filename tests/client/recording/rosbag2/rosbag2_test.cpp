#include "telltale/client/recording/rosbag2/rosbag2.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/compression.hpp"
#include "support/ros_messages.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/load_recording.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Bytes AsItIs(const Bytes& bytes) {
  return bytes;
}

Bytes ByMessage(const Bytes& bytes) {
  const std::string packed = Zstd({bytes.begin(), bytes.end()});
  return {packed.begin(), packed.end()};
}

/// Storage as rosbag2 makes it: its tables are those of rosbag2_storage_sqlite3, version 4.
class Rosbag2 : public testing::Test {
 protected:
  /// One second of a boat, from `second` on.
  void WriteStorage(const std::string& name, std::int32_t second,
                    Bytes (*stored)(const Bytes&) = AsItIs) {
    SQLite::Database database((bag_ / name).string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
        "INTEGER NOT NULL, data BLOB NOT NULL);"
        "INSERT INTO topics VALUES(1, '/fix', 'sensor_msgs/msg/NavSatFix', 'cdr', ''),"
        "(2, '/imu', 'sensor_msgs/msg/Imu', 'cdr', ''),"
        "(3, '/rc/out', 'mavros_msgs/msg/RCOut', 'cdr', '')");
    const auto add = [&](int topic, const Bytes& message) {
      const Bytes data = stored(message);
      SQLite::Statement insert(database,
                               "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)");
      insert.bind(1, topic);
      insert.bind(2, std::int64_t{second} * 1'000'000'000);
      insert.bind(3, data.data(), static_cast<int>(data.size()));
      insert.exec();
    };
    add(1, NavSatFix(second, 0));
    add(2, Imu(second, 0.0, "base_link"));
    add(3, RcOut(second, {1600, 1500, 1400}));
  }

  /// Compresses a file of the bag as a whole, as ros2 bag names it.
  void CompressFile(const std::string& name) {
    WriteFile(bag_ / (name + ".zstd"), Zstd(*ReadFile(bag_ / name)));
    std::filesystem::remove(bag_ / name);
  }

  static std::vector<double> FixTimes(const SourceLog& log) {
    std::vector<double> times_s;
    for (const GnssFix& fix : log.gnss) times_s.push_back(fix.time_s);
    return times_s;
  }

  TemporaryFolder folder_;
  const std::filesystem::path bag_ = folder_.Path() / "bag";

  void SetUp() override { std::filesystem::create_directories(bag_); }
};

TEST_F(Rosbag2, OfSeveralFilesIsOneRecording) {
  WriteStorage("bag_0.db3", 100);
  WriteStorage("bag_1.db3", 101);
  EXPECT_EQ(FormatOf(bag_), LogFormat::kRosbag2);
  const auto log = ReadRosbag2(bag_);
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_THAT(FixTimes(*log), testing::ElementsAre(100.0, 101.0));
  EXPECT_EQ(log->thrusters.at(1).port_us, 1600.0);
}

TEST_F(Rosbag2, OfManyFilesIsInTheOrderOfTheirNumbers) {
  for (const int part : {1, 2, 10}) {
    WriteStorage("bag_" + std::to_string(part) + ".db3", 100 + part);
  }
  const auto log = ReadRosbag2(bag_);
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_THAT(FixTimes(*log), testing::ElementsAre(101.0, 102.0, 110.0));
}

TEST_F(Rosbag2, PassesOverTopicsOfNoUse) {
  WriteStorage("bag_0.db3", 100);
  SQLite::Database database((bag_ / "bag_0.db3").string(), SQLite::OPEN_READWRITE);
  database.exec(
      "INSERT INTO topics VALUES(4, '/camera', 'sensor_msgs/msg/Image', 'cdr', '');"
      "INSERT INTO messages(topic_id, timestamp, data) VALUES(4, 100000000000, x'00')");
  const auto log = ReadRosbag2(bag_);
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_THAT(log->summary, HasSubstr("3 messages of use in 3 topics"));
}

TEST_F(Rosbag2, MayCompressEachMessage) {
  WriteStorage("bag_0.db3", 100, ByMessage);
  const auto log = ReadRosbag2(bag_ / "bag_0.db3");
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_THAT(FixTimes(*log), testing::ElementsAre(100.0));
}

TEST_F(Rosbag2, MayCompressFilesAsAWhole) {
  WriteStorage("bag_0.db3", 100);
  CompressFile("bag_0.db3");
  WriteStorage("bag_1.db3", 101);
  EXPECT_EQ(FormatOf(bag_), LogFormat::kRosbag2);
  EXPECT_EQ(FormatOf(bag_ / "bag_0.db3.zstd"), LogFormat::kCompressed);
  const auto log = ReadRosbag2(bag_);
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_THAT(FixTimes(*log), testing::ElementsAre(100.0, 101.0));
  const auto one = ReadRosbag2(bag_ / "bag_0.db3.zstd");
  ASSERT_TRUE(one) << one.error().reason;
  EXPECT_THAT(FixTimes(*one), testing::ElementsAre(100.0));
}

TEST_F(Rosbag2, TakesNoViewForATable) {
  SQLite::Database database((bag_ / "bag_0.db3").string(),
                            SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec(
      "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT);"
      "CREATE VIEW messages AS WITH RECURSIVE endless(timestamp) AS (SELECT 0 UNION ALL SELECT "
      "timestamp + 1 FROM endless) SELECT 1 AS topic_id, timestamp, x'00' AS data FROM endless");
  const auto log = ReadRosbag2(bag_);
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().reason, HasSubstr("it has no table messages"));
}

TEST_F(Rosbag2, NamesTheCompressedFileThatIsCutOff) {
  WriteStorage("bag_0.db3", 100);
  CompressFile("bag_0.db3");
  const auto file = bag_ / "bag_0.db3.zstd";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const auto log = ReadRosbag2(bag_);
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().subject, HasSubstr("bag_0.db3.zstd, which is cut off"));
}

TEST_F(Rosbag2, NamesTheFileThatOnlySeemsCompressed) {
  WriteFile(bag_ / "bag_0.db3.zstd", "\x28\xB5\x2F\xFD and no frame");
  const auto log = ReadRosbag2(bag_);
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().subject, HasSubstr("bag_0.db3.zstd"));
  EXPECT_THAT(log.error().reason, HasSubstr("cannot be decompressed"));
}

TEST_F(Rosbag2, CountsCompressedMessagesThatCannotBeInflated) {
  WriteStorage("bag_0.db3", 100);
  WriteStorage("bag_1.db3", 101, [](const Bytes& bytes) {
    Bytes broken = ByMessage(bytes);
    broken.resize(broken.size() - 3);
    return broken;
  });
  const auto log = ReadRosbag2(bag_);
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_EQ(log->gnss.size(), 1u);
  EXPECT_THAT(log->summary, HasSubstr("1 unreadable messages of /fix"));
}

}  // namespace
}  // namespace telltale
