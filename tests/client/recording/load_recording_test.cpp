#include "telltale/client/recording/load_recording.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/compression.hpp"
#include "support/dataflash_writer.hpp"
#include "telltale/client/recording/gzip_file.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

class Loading : public testing::Test {
 protected:
  Loading() { std::filesystem::create_directories(folder_); }
  ~Loading() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path Save(const DataFlashWriter& writer) const {
    Write("log.BIN", std::string(writer.Bytes().begin(), writer.Bytes().end()));
    return folder_ / "log.BIN";
  }
  void Write(const char* name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }

  const std::filesystem::path folder_ =
      testing::TempDir() + "telltale_" +
      testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Loading, TakesADataFlashFile) {
  const auto loaded = LoadRecording(Save(Rover4Writer().WholeLog(50)));
  ASSERT_TRUE(loaded) << loaded.error().reason;
  EXPECT_EQ(loaded->recording.gnss.size(), 50u);
  EXPECT_EQ(loaded->recording.heading.size(), 100u);
  EXPECT_EQ(loaded->recording.thrusters.size(), 100u);
  EXPECT_EQ(loaded->recording.rejected.Total(), 0u);
  EXPECT_EQ(loaded->evicted, 0u);
  ASSERT_TRUE(loaded->description);
  EXPECT_THAT(loaded->description->summary, HasSubstr("heading from ATT"));
  EXPECT_THAT(loaded->description->summary, HasSubstr("3 (port) and 1 (starboard) of RCOU"));
}

TEST_F(Loading, TakesAFolderWithTheSameOutcome) {
  Write("gnss.csv", "time_s,latitude_deg,longitude_deg\n1,63.4,10.3\n1.2,63.5,10.4\n");
  Write("heading.csv", "time_s,heading_deg\n1,10\n1.1,11\n");
  Write("thrusters.csv", "time_s,left_us,right_us\n1,1600,1400\n1.1,1610,1390\n");
  const auto loaded = LoadRecording(folder_);
  ASSERT_TRUE(loaded) << loaded.error().reason;
  EXPECT_EQ(loaded->recording.gnss.size(), 2u);
  EXPECT_FALSE(loaded->description);

  Rover4Writer writer;
  writer.Definitions().Parm("SERVO3_FUNCTION", 73).Parm("SERVO1_FUNCTION", 74);
  writer.Gps(1'000'000, 0, 3, 634000000, 103000000).Gps(1'200'000, 0, 3, 635000000, 104000000);
  writer.Att(1'000'000, 1000).Att(1'100'000, 1100);
  writer.Rcou(1'000'000, 1400, 0, 1600).Rcou(1'100'000, 1390, 0, 1610);
  const auto same = LoadRecording(Save(writer));
  ASSERT_TRUE(same) << same.error().reason;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_DOUBLE_EQ(same->recording.gnss[i].time_s, loaded->recording.gnss[i].time_s);
    EXPECT_EQ(same->recording.gnss[i].latitude_deg, loaded->recording.gnss[i].latitude_deg);
    EXPECT_EQ(same->recording.gnss[i].longitude_deg, loaded->recording.gnss[i].longitude_deg);
    EXPECT_EQ(same->recording.heading[i].heading_deg, loaded->recording.heading[i].heading_deg);
    EXPECT_EQ(same->recording.thrusters[i].port_us, loaded->recording.thrusters[i].port_us);
    EXPECT_EQ(same->recording.thrusters[i].starboard_us,
              loaded->recording.thrusters[i].starboard_us);
  }
}

TEST_F(Loading, BadSamplesOfADataFlashFileAreRejectedByReason) {
  Rover4Writer writer;
  writer.WholeLog(20);
  writer.Rcou(14'000'000, 0, 0, 0);             // outputs off
  writer.Gps(14'000'000, 0, 3, 1900000000, 0);  // 190 degrees north
  writer.Att(14'001'000, 100).Att(14'001'000, 100);
  const auto loaded = LoadRecording(Save(writer));
  ASSERT_TRUE(loaded) << loaded.error().reason;
  const RejectCounts& rejected = loaded->recording.rejected;
  EXPECT_EQ(rejected.Of(Channel::kThrusters, RejectReason::kOutOfRange), 1u);
  EXPECT_EQ(rejected.Of(Channel::kGnss, RejectReason::kOutOfRange), 1u);
  EXPECT_EQ(rejected.Of(Channel::kHeading, RejectReason::kDuplicate), 1u);
  EXPECT_EQ(rejected.Total(), 3u);
}

TEST_F(Loading, ALeapOfOneSampleIsReportedAndRejected) {
  Rover4Writer writer;
  writer.WholeLog(20).Gps(900'000'000, 0, 3, 634014986, 103146182).Run(20, 14'000'000);
  const auto loaded = LoadRecording(Save(writer));
  ASSERT_TRUE(loaded) << loaded.error().reason;
  // There and back.
  EXPECT_THAT(loaded->description->summary, HasSubstr("2 leaps in time in GPS"));
  EXPECT_EQ(loaded->recording.rejected.Of(Channel::kGnss, RejectReason::kClockJump), 1u);
  EXPECT_EQ(loaded->recording.gnss.size(), 40u);
}

TEST_F(Loading, RefusalsNameThePath) {
  const auto file = Save(Rover4Writer().Definitions());
  const auto lacking = LoadRecording(file);
  ASSERT_FALSE(lacking);
  EXPECT_THAT(lacking.error().subject, HasSubstr(file.string()));
  EXPECT_THAT(lacking.error().reason, HasSubstr("no GPS message"));

  const auto absent = LoadRecording(folder_ / "absent.BIN");
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().subject, HasSubstr("absent.BIN"));

  Rover4Writer off;
  off.Definitions().Parm("SERVO3_FUNCTION", 73).Parm("SERVO1_FUNCTION", 74);
  off.Gps(1, 0, 3, 1, 1).Att(1, 1).Rcou(1, 0, 0, 0);
  const auto unusable = LoadRecording(Save(off));
  ASSERT_FALSE(unusable);
  EXPECT_THAT(unusable.error().subject, HasSubstr("log.BIN thrusters"));
  EXPECT_THAT(unusable.error().reason, HasSubstr("OUT_OF_RANGE"));
}

TEST_F(Loading, TakesWhatGzipOrZstdHasCompressed) {
  const DataFlashWriter writer = Rover4Writer().WholeLog(50);
  const auto plain = LoadRecording(Save(writer));
  ASSERT_TRUE(plain) << plain.error().reason;
  for (const char* name : {"log.BIN.gz", "log.BIN.zst"}) {
    const std::string content(writer.Bytes().begin(), writer.Bytes().end());
    Write(name, std::string(name).ends_with(".gz") ? Gzip(content) : Zstd(content));
    const auto loaded = LoadRecording(folder_ / name);
    ASSERT_TRUE(loaded) << loaded.error().reason;
    EXPECT_EQ(loaded->recording.gnss.size(), 50u) << name;
    EXPECT_EQ(loaded->description->summary, plain->description->summary) << name;
  }
}

TEST_F(Loading, SaysThatACompressedFileIsCutOff) {
  const DataFlashWriter writer = Rover4Writer().WholeLog(50);
  const std::string whole = Gzip(std::string(writer.Bytes().begin(), writer.Bytes().end()));
  Write("log.BIN.gz", whole.substr(0, whole.size() - 20));
  const auto loaded = LoadRecording(folder_ / "log.BIN.gz");
  ASSERT_TRUE(loaded) << loaded.error().reason;
  EXPECT_THAT(loaded->description->summary, HasSubstr("the compressed file is cut off"));
  Write("empty.gz", Gzip(""));
  const auto empty = LoadRecording(folder_ / "empty.gz");
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().subject, (folder_ / "empty.gz").string());
  EXPECT_EQ(empty.error().reason, "is empty");
}

TEST_F(Loading, InflatesNoMoreThanItMay) {
  const std::string zeros(1'000'000, '\0');
  Write("zeros.gz", Gzip(zeros));
  Write("zeros.zst", Zstd(zeros));
  constexpr std::uint64_t kMost = 500'000;
  for (const auto& inflated : {InflateGzipFile(folder_ / "zeros.gz", folder_ / "zeros", kMost),
                               InflateZstdFile(folder_ / "zeros.zst", folder_ / "zeros", kMost)}) {
    ASSERT_FALSE(inflated);
    EXPECT_EQ(inflated.error().reason, "inflates to more than 0.0005 GB");
    EXPECT_LE(std::filesystem::file_size(folder_ / "zeros"), kMost);
  }
  std::uint64_t handed_over = 0;
  const auto take = [&](std::span<const std::uint8_t> bytes, bool) {
    handed_over += bytes.size();
    return bytes.size();
  };
  const auto in_blocks = ReadZstdInBlocks(folder_ / "zeros.zst", take, nullptr, kMost);
  ASSERT_FALSE(in_blocks);
  EXPECT_EQ(in_blocks.error().reason, "inflates to more than 0.0005 GB");
  EXPECT_LE(handed_over, kMost);
}

TEST_F(Loading, TakesTheOneRecordingOfAFolderAndNamesSeveral) {
  Write("notes.txt", "calm");
  Save(Rover4Writer().WholeLog(50));
  const auto one = LoadRecording(folder_);
  ASSERT_TRUE(one) << one.error().reason;
  EXPECT_EQ(one->recording.gnss.size(), 50u);
  std::filesystem::copy(folder_ / "log.BIN", folder_ / "more.BIN");
  const auto two = LoadRecording(folder_);
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().reason, "holds 2 recordings: log.BIN, more.BIN");
  EXPECT_THAT(two.error().advice, HasSubstr("--log of its own"));
}

TEST_F(Loading, NamesAFormatThatItKnowsAndDoesNotRead) {
  using namespace std::string_literals;
  const std::map<std::string, const char*> reasons = {
      {"ULog\x01\x12\x35 and so on", "ULog of PX4"},
      {"FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n", "turned into text"},
      {"PK\x03\x04", "zip archive"},
      {"BZh91AY", "bzip2"},
      {"stamp;lat;lon;hdg\n1;2;3;4\n", "begins with stamp;lat;lon;hdg"},
      {"one, two\n", "is of no format"},
      {"a,b,c\0d"s, "is of no format"}};
  for (const auto& [content, reason] : reasons) {
    Write("file", content);
    const auto refused = LoadRecording(folder_ / "file");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().reason, HasSubstr(reason));
  }
}

TEST_F(Loading, TheLogsServoParametersMakeAVehicle) {
  const auto log = ReadLog(Save(Rover4Writer().WholeLog(1)));
  ASSERT_TRUE(log);
  const auto vehicle = VehicleFrom(*log->description, "blueboat-1");
  ASSERT_TRUE(vehicle);
  EXPECT_EQ(vehicle->vehicle_id, "blueboat-1");
  // Full forward of both: above neutral to port, below it on the reversed starboard channel.
  EXPECT_DOUBLE_EQ(vehicle->Normalise(1900, 1100).port, 1.0);
  EXPECT_DOUBLE_EQ(vehicle->Normalise(1900, 1100).starboard, 1.0);

  Rover4Writer unsaid;
  unsaid.Definitions().Parm("SERVO3_FUNCTION", 73).Parm("SERVO1_FUNCTION", 74).Run(1);
  const auto without = ReadLog(Save(unsaid));
  ASSERT_TRUE(without);
  const auto refused = VehicleFrom(*without->description, "blueboat-1");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().subject, "port thruster");
  EXPECT_THAT(refused.error().reason, HasSubstr("SERVO3_MIN"));
}

}  // namespace
}  // namespace telltale
