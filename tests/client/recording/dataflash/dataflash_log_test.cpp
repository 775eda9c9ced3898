#include "telltale/client/recording/dataflash/dataflash_log.hpp"

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/dataflash_writer.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Counts = std::map<std::string, std::uint64_t>;

DataFlashLog Parse(const DataFlashWriter& writer, const DataFlashOptions& options = {}) {
  return ParseDataFlash(writer.Bytes(), options);
}

/// "A3 95 80" as bytes, then as many zeros as asked.
Bytes Hex(const std::string& text, std::size_t zeros = 0) {
  Bytes bytes;
  for (std::size_t at = 0; at < text.size(); at += 3) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(at, 2), nullptr, 16)));
  }
  bytes.insert(bytes.end(), zeros, 0);
  return bytes;
}

/// Two thrusters on channels 3 (port) and 1 (starboard, reversed).
Rover4Writer Ready() {
  Rover4Writer writer;
  writer.Definitions().Output(1, 74, 1100, 1511, 1900, true);
  writer.Output(3, 73, 1100, 1511, 1900, false);
  return writer;
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const Bytes& bytes)
      : path_(testing::TempDir() + "dataflash_" +
              testing::UnitTest::GetInstance()->current_test_info()->name() + ".BIN") {
    std::ofstream out(path_, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(DataFlash, ThinsWhatOutgrowsItsMemoryAndSaysSo) {
  Rover4Writer writer = Ready();
  for (std::uint64_t ms = 0; ms < 60'000; ++ms) {  // a minute of attitudes at 1 kHz
    writer.Att(1000 * ms, 9000);
    if (ms % 100 == 0) writer.Rcou(1000 * ms, 1500, 1500, 1600);
  }
  DataFlashOptions options;
  options.memory_bytes = 100'000;
  const DataFlashLog log = Parse(writer, options);
  EXPECT_EQ(log.heading.size(), 60u * 50u);
  EXPECT_EQ(log.thrusters.size(), 600u);
  EXPECT_THAT(log.report.Summary(), HasSubstr("thinned by whole samples to 50 Hz"));
}

TEST(DataFlash, ReadsAFileCheckedByHand) {
  DataFlashWriter file;
  // FMT: type 130, length 3+8+1+4+4 = 20 = 0x14, "GPS", "QBLL", "TimeUS,Status,Lat,Lng" and 43 NULs
  file.Raw(Hex("A3 95 80 82 14 47 50 53 00 51 42 4C 4C", 12));
  file.Raw(Hex("54 69 6D 65 55 53 2C 53 74 61 74 75 73 2C 4C 61 74 2C 4C 6E 67", 43));
  // FMT: type 131, length 3+8+2 = 13 = 0x0D, "ATT", "QC", "TimeUS,Yaw" and 54 NULs
  file.Raw(Hex("A3 95 80 83 0D 41 54 54 00 51 43", 14));
  file.Raw(Hex("54 69 6D 65 55 53 2C 59 61 77", 54));
  // FMT: type 132, length 3+8+2+2 = 15 = 0x0F, "RCOU", "QHH", "TimeUS,C1,C2" and 52 NULs
  file.Raw(Hex("A3 95 80 84 0F 52 43 4F 55 51 48 48", 13));
  file.Raw(Hex("54 69 6D 65 55 53 2C 43 31 2C 43 32", 52));
  // FMT: type 133, length 3+16+4 = 23 = 0x17, "PARM", "Nf", "Name,Value" and 54 NULs
  file.Raw(Hex("A3 95 80 85 17 50 41 52 4D 4E 66", 14));
  file.Raw(Hex("4E 61 6D 65 2C 56 61 6C 75 65", 54));
  // PARM "SERVO1_FUNCTION" NUL, 73.0f = 0x42920000
  file.Raw(Hex("A3 95 85 53 45 52 56 4F 31 5F 46 55 4E 43 54 49 4F 4E 00 00 00 92 42"));
  // PARM "SERVO2_FUNCTION" NUL, 74.0f = 0x42940000
  file.Raw(Hex("A3 95 85 53 45 52 56 4F 32 5F 46 55 4E 43 54 49 4F 4E 00 00 00 94 42"));
  // GPS at 0x16E360 = 1500000 us, Status 3, Lat 0x25CA4D0A = 634014986, Lng 0xFC6D53C0 = -59944000
  file.Raw(Hex("A3 95 82 60 E3 16 00 00 00 00 00 03 0A 4D CA 25 C0 53 6D FC"));
  // ATT at 0x186A00 = 1600000 us, Yaw 0x49B4 = 18868 hundredths of a degree
  file.Raw(Hex("A3 95 83 00 6A 18 00 00 00 00 00 B4 49"));
  // RCOU at 0x19F0A0 = 1700000 us, C1 0x064B = 1611 us, C2 0x0583 = 1411 us
  file.Raw(Hex("A3 95 84 A0 F0 19 00 00 00 00 00 4B 06 83 05"));
  ASSERT_EQ(file.size(), 4u * 89 + 2 * 23 + 20 + 13 + 15);

  const DataFlashLog log = Parse(file);
  EXPECT_TRUE(log.Lacks().empty());
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_DOUBLE_EQ(log.gnss[0].time_s, 1.5);
  EXPECT_EQ(log.gnss[0].latitude_deg, 63.4014986);
  EXPECT_EQ(log.gnss[0].longitude_deg, -5.9944);
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_DOUBLE_EQ(log.heading[0].time_s, 1.6);
  EXPECT_EQ(log.heading[0].heading_deg, 188.68);
  ASSERT_EQ(log.thrusters.size(), 1u);
  EXPECT_DOUBLE_EQ(log.thrusters[0].time_s, 1.7);
  EXPECT_EQ(log.thrusters[0].port_us, 1611.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1411.0);
  const Counts records = {{"FMT", 4}, {"PARM", 2}, {"GPS", 1}, {"ATT", 1}, {"RCOU", 1}};
  EXPECT_EQ(log.report.records, records);
  EXPECT_EQ(log.report.damage, DataFlashDamage{});
}

TEST(DataFlash, ReadsRover4) {
  const DataFlashLog log = Parse(Rover4Writer().WholeLog(50));
  EXPECT_TRUE(log.Lacks().empty());
  ASSERT_EQ(log.gnss.size(), 50u);
  ASSERT_EQ(log.heading.size(), 100u);
  ASSERT_EQ(log.thrusters.size(), 100u);
  EXPECT_DOUBLE_EQ(log.gnss[49].time_s, 19.8);
  EXPECT_EQ(log.gnss[49].latitude_deg, 63.4015476);
  EXPECT_EQ(log.heading[99].heading_deg, 45.49);
  EXPECT_DOUBLE_EQ(log.thrusters[99].time_s, 19.902);
  EXPECT_EQ(log.thrusters[99].port_us, 1660.0);
  EXPECT_EQ(log.thrusters[99].starboard_us, 1362.0);
  EXPECT_EQ(log.report.heading_source, HeadingSource::kAtt);
  EXPECT_EQ(log.report.gps_instance, 0);
  EXPECT_EQ(log.report.unreadable, Counts{});
  EXPECT_EQ(log.report.time_leaps, Counts{});
}

TEST(DataFlash, ServoParametersGiveTheChannelsRanges) {
  const DataFlashLog log = Parse(Rover4Writer().WholeLog(1));
  ASSERT_TRUE(log.port && log.starboard && log.port->range && log.starboard->range);
  EXPECT_EQ(log.port->channel, 3);
  EXPECT_EQ(log.port->range->neutral_us, 1511.0);
  EXPECT_EQ(log.port->range->full_forward_us, 1900.0);
  EXPECT_EQ(log.port->range->full_reverse_us, 1100.0);
  EXPECT_EQ(log.starboard->channel, 1);  // reversed: forward lies below neutral
  EXPECT_EQ(log.starboard->range->neutral_us, 1511.0);
  EXPECT_EQ(log.starboard->range->full_forward_us, 1100.0);
  EXPECT_EQ(log.starboard->range->full_reverse_us, 1900.0);
}

TEST(DataFlash, UnsoundServoParametersGiveNoRangeAndSayWhy) {
  Rover4Writer writer;
  writer.Definitions().Output(1, 74, 1900, 1511, 1100, false).Parm("SERVO3_FUNCTION", 73).Run(1);
  const DataFlashLog log = Parse(writer);
  // The recording is of use; a vehicle file must give the range.
  EXPECT_TRUE(log.Lacks().empty());
  ASSERT_TRUE(log.port && log.starboard);
  EXPECT_FALSE(log.port->range);
  EXPECT_THAT(log.port->range_fault, HasSubstr("SERVO3_MIN"));
  EXPECT_FALSE(log.starboard->range);
  EXPECT_THAT(log.starboard->range_fault, AllOf(HasSubstr("SERVO1_MIN"), HasSubstr("1900")));
}

TEST(DataFlash, AParameterChangedUnderWayIsCountedAndTheLastValueRules) {
  Rover4Writer writer = Ready();
  writer.Run(1).Parm("SERVO3_TRIM", 1520).Parm("SERVO3_TRIM", 1520);
  const DataFlashLog log = Parse(writer);
  EXPECT_EQ(log.report.changed_parameters, (Counts{{"SERVO3_TRIM", 1}}));
  EXPECT_EQ(log.port->range->neutral_us, 1520.0);
}

TEST(DataFlash, ChannelsCanBeGiven) {
  Rover4Writer writer;
  writer.Definitions().Run(2);
  DataFlashOptions options;
  options.port_channel = 1;
  options.starboard_channel = 2;
  const DataFlashLog log = Parse(writer, options);
  ASSERT_EQ(log.thrusters.size(), 4u);
  EXPECT_EQ(log.thrusters[0].port_us, 1411.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1500.0);
}

TEST(DataFlash, RefusesTheOutputOfPortForStarboard) {
  Rover4Writer writer = Ready();
  writer.Run(2);
  DataFlashOptions options;
  options.starboard_channel = Parse(writer).port->channel;
  const DataFlashLog log = Parse(writer, options);
  EXPECT_TRUE(log.thrusters.empty());
  EXPECT_EQ(log.Lacks().back().subject, "starboard_channel");
}

// Rover 2.x and Copter 3.2: no TimeUS; TimeMS of a GPS message is the GPS week's, T the
// autopilot's.
TEST(DataFlash, ReadsTimeMsFirmware) {
  DataFlashWriter writer;
  writer.Fmt(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  writer.Fmt(129, 23, "PARM", "Nf", "Name,Value");
  writer.Fmt(130, 45, "GPS", "BIHBcLLeeEefI",
             "Status,TimeMS,Week,NSats,HDop,Lat,Lng,RelAlt,Alt,Spd,GCrs,VZ,T");
  writer.Fmt(136, 19, "ATT", "IccccCC", "TimeMS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw");
  writer.Fmt(140, 23, "RCOU", "Ihhhhhhhh",
             "TimeMS,Chan1,Chan2,Chan3,Chan4,Chan5,Chan6,Chan7,Chan8");
  const auto parameter = [&](const char* name, float value) {
    writer.Header(129).Text(name, 16).F32(value);
  };
  parameter("RC1_FUNCTION", 73);
  parameter("RC1_MIN", 1000);
  parameter("RC1_TRIM", 1500);
  parameter("RC1_MAX", 2000);
  parameter("RC1_REV", 1);
  parameter("RC3_FUNCTION", 74);
  parameter("RC3_MIN", 1000);
  parameter("RC3_TRIM", 1500);
  parameter("RC3_MAX", 2000);
  parameter("RC3_REV", -1);
  writer.Header(130).U8(3).U32(130040903).U16(1769).U8(10).I16(0).I32(-353547178).I32(1491696673);
  writer.I32(88552).I32(87045).U32(2456).I32(32144).F32(2.45f).U32(127615);
  writer.Header(136).U32(127700).I16(0).I16(0).I16(0).I16(0).U16(0).U16(35999);
  writer.Header(140).U32(127800).I16(1600).I16(0).I16(1400);
  for (int channel = 4; channel <= 8; ++channel) writer.I16(0);

  const DataFlashLog log = Parse(writer);
  EXPECT_TRUE(log.Lacks().empty());
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_DOUBLE_EQ(log.gnss[0].time_s, 127.615);
  EXPECT_EQ(log.gnss[0].latitude_deg, -35.3547178);
  EXPECT_EQ(log.gnss[0].longitude_deg, 149.1696673);
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_DOUBLE_EQ(log.heading[0].time_s, 127.7);
  EXPECT_EQ(log.heading[0].heading_deg, 359.99);
  ASSERT_EQ(log.thrusters.size(), 1u);
  EXPECT_DOUBLE_EQ(log.thrusters[0].time_s, 127.8);
  EXPECT_EQ(log.thrusters[0].port_us, 1600.0);
  EXPECT_EQ(log.thrusters[0].starboard_us, 1400.0);
  ASSERT_TRUE(log.port->range && log.starboard->range);
  EXPECT_EQ(log.port->range->full_forward_us, 2000.0);
  EXPECT_EQ(log.starboard->range->full_forward_us, 1000.0);
}

TEST(DataFlash, GpsTimeAloneIsNoClockToSetBesideTheOthers) {
  DataFlashWriter writer;
  writer.Fmt(130, 18, "GPS", "BIHLL", "Status,TimeMS,Week,Lat,Lng");
  writer.Header(130).U8(3).U32(1).U16(1769).I32(1).I32(2);
  const DataFlashLog log = Parse(writer);
  EXPECT_TRUE(log.gnss.empty());
  EXPECT_EQ(log.report.unreadable, (Counts{{"GPS without TimeUS or T", 1}}));
}

TEST(DataFlash, RcParametersAreInputsWhereServoParametersExist) {
  Rover4Writer writer = Ready();
  writer.Parm("RC3_TRIM", 1234).Parm("RC3_REV", -1).Run(1);
  EXPECT_EQ(Parse(writer).port->range->neutral_us, 1511.0);
  EXPECT_EQ(Parse(writer).port->range->full_forward_us, 1900.0);
}

TEST(DataFlash, ReceiversAreNeverMixed) {
  Rover4Writer writer = Ready();
  for (std::uint64_t i = 0; i < 10; ++i) {
    writer.Gps(1'000'000 + i * 200'000, 0, i < 6 ? 3 : 1, 100, 100);
    writer.Gps(1'050'000 + i * 200'000, 1, 4, 200, 200);
  }
  writer.Att(1, 0).Rcou(1, 1500, 1500, 1500);
  const DataFlashLog most = Parse(writer);
  EXPECT_EQ(most.report.gps_instance, 1);
  EXPECT_EQ(most.report.gps_fixes, (std::map<int, std::uint64_t>{{0, 6}, {1, 10}}));
  EXPECT_EQ(most.report.gps_without_fix, 4u);
  ASSERT_EQ(most.gnss.size(), 10u);
  for (const GnssFix& fix : most.gnss) EXPECT_EQ(fix.latitude_deg, 2e-5);

  DataFlashOptions options;
  options.gps_instance = 0;
  const DataFlashLog asked = Parse(writer, options);
  ASSERT_EQ(asked.gnss.size(), 6u);
  for (const GnssFix& fix : asked.gnss) EXPECT_EQ(fix.latitude_deg, 1e-5);

  options.gps_instance = 7;
  const auto lacks = Parse(writer, options).Lacks();
  ASSERT_EQ(lacks.size(), 1u);
  EXPECT_THAT(lacks[0].advice, HasSubstr("0 1"));
}

TEST(DataFlash, TheFirstOfEquallyCompleteReceiversIsTaken) {
  Rover4Writer writer = Ready();
  writer.Gps(1, 1, 3, 200, 200).Gps(2, 0, 3, 100, 100);
  EXPECT_EQ(Parse(writer).report.gps_instance, 0);
}

TEST(DataFlash, OlderFirmwareNamesItsSecondReceiverGps2) {
  Rover4Writer writer = Ready();
  writer.Fmt(150, 20, "GPS2", "QBLL", "TimeUS,Status,Lat,Lng");
  writer.Gps(1'000'000, 0, 3, 100, 100).Gps(2'000'000, 0, 3, 100, 100);
  writer.Header(150).U64(1'500'000).U8(3).I32(300).I32(300);
  EXPECT_EQ(Parse(writer).gnss.size(), 2u);
  DataFlashOptions options;
  options.gps_instance = 1;
  ASSERT_EQ(Parse(writer, options).gnss.size(), 1u);
  EXPECT_EQ(Parse(writer, options).gnss[0].latitude_deg, 3e-5);
}

TEST(DataFlash, HeadingComesFromAttAndOnlyWithoutItFromAhr2) {
  Rover4Writer writer = Ready();
  writer.Ahr2(1'000'000, 9000);
  EXPECT_EQ(Parse(writer).report.heading_source, HeadingSource::kAhr2);
  EXPECT_EQ(Parse(writer).heading.at(0).heading_deg, 90.0);
  writer.Att(1'100'000, 18000);
  EXPECT_EQ(Parse(writer).report.heading_source, HeadingSource::kAtt);
  ASSERT_EQ(Parse(writer).heading.size(), 1u);
  EXPECT_EQ(Parse(writer).heading[0].heading_deg, 180.0);
}

TEST(DataFlash, NamesWhatIsMissing) {
  const auto lacks = [](const DataFlashWriter& writer) {
    const auto channels = Parse(writer).Lacks();
    EXPECT_FALSE(channels.empty());
    return channels.empty() ? Refusal{} : channels.front();
  };
  EXPECT_THAT(Parse(DataFlashWriter()).Unreadable()->reason, HasSubstr("empty"));
  EXPECT_THAT(Parse(DataFlashWriter().Text("time_s,latitude_deg\n1,2\n", 24)).Unreadable()->reason,
              HasSubstr("not a DataFlash log"));

  Rover4Writer writer = Ready();
  EXPECT_THAT(lacks(writer).reason, HasSubstr("no GPS message"));
  EXPECT_THAT(lacks(writer).advice, HasSubstr("LOG_BITMASK"));
  writer.Gps(1'000'000, 0, 1, 0, 0).Gps(1'200'000, 0, 2, 0, 0);
  EXPECT_THAT(lacks(writer).reason, AllOf(HasSubstr("no fix"), HasSubstr("2 GPS records")));
  EXPECT_EQ(Parse(writer).report.gps_without_fix, 2u);
  writer.Gps(1'400'000, 0, 3, 1, 1);
  EXPECT_THAT(lacks(writer).reason, HasSubstr("no ATT or AHR2"));
  writer.Att(1'400'000, 100);
  EXPECT_THAT(lacks(writer).reason, HasSubstr("no RCOU"));
  EXPECT_THAT(lacks(writer).advice, AllOf(HasSubstr("LOG_BITMASK"), HasSubstr("RC")));
  writer.Rcou(1'400'000, 1500, 1500, 1500);
  EXPECT_TRUE(Parse(writer).Lacks().empty());
}

TEST(DataFlash, NamesTheThrusterParameterThatIsMissing) {
  Rover4Writer writer;
  writer.Definitions().Parm("SERVO1_FUNCTION", 73).Run(1);
  EXPECT_THAT(Parse(writer).Lacks().front().reason, HasSubstr("74 (ThrottleRight)"));
  writer.Parm("SERVO17_FUNCTION", 74);
  EXPECT_THAT(Parse(writer).Lacks().front().reason, HasSubstr("channel 17"));
}

TEST(DataFlash, AMessageWithoutItsColumnsIsReportedByWhatItLacks) {
  DataFlashWriter writer;
  writer.Fmt(1, 12, "GPS", "QB", "TimeUS,Status").Fmt(2, 5, "ATT", "C", "Yaw");
  writer.Fmt(3, 13, "RCOU", "QH", "TimeUS,X1");
  writer.Header(1).U64(1).U8(3).Header(2).U16(1).Header(3).U64(1).U16(1500);
  EXPECT_EQ(Parse(writer).report.unreadable, (Counts{{"GPS without Lat", 1},
                                                     {"ATT without TimeUS or TimeMS", 1},
                                                     {"RCOU without C1", 1}}));
}

TEST(DataFlash, LeapsInTimeAreCountedByMessage) {
  Rover4Writer writer = Ready();
  writer.Run(3, 10'000'000).Run(3, 5'000'000).Run(3, 500'000'000);
  const DataFlashLog log = Parse(writer);
  EXPECT_EQ(log.report.time_leaps, (Counts{{"GPS", 2}, {"ATT", 2}, {"RCOU", 2}}));
  EXPECT_THAT(log.report.Summary(), HasSubstr("2 leaps in time in GPS"));
  EXPECT_EQ(log.gnss.size(), 9u);  // the window checks it, not the reader
}

TEST(DataFlash, ATypeRedefinedUnderWayIsReadByItsNewLayout) {
  Rover4Writer writer = Ready();
  writer.Gps(1'000'000, 0, 3, 100, 100);
  writer.Fmt(Rover4Writer::kGps, 20, "GPS", "QBLL", "TimeUS,Status,Lat,Lng");
  writer.Header(Rover4Writer::kGps).U64(2'000'000).U8(3).I32(200).I32(300);
  const DataFlashLog log = Parse(writer);
  ASSERT_EQ(log.gnss.size(), 2u);
  EXPECT_EQ(log.gnss[1].longitude_deg, 3e-5);
  EXPECT_EQ(log.report.damage.redefinitions, 1u);
  EXPECT_EQ(log.report.records.at("GPS"), 2u);
}

TEST(DataFlash, TruncatedAnywhereItGivesWhatCameBefore) {
  const Bytes whole = Rover4Writer().WholeLog(4).Bytes();
  const DataFlashLog complete = ParseDataFlash(whole, {});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const DataFlashLog log = ParseDataFlash(cut, {});
    EXPECT_EQ(log.report.damage.corrupt_records, 0u) << size;
    EXPECT_LT(log.report.damage.truncated_bytes, 89u) << size;
    ASSERT_LE(log.gnss.size(), complete.gnss.size());
    for (std::size_t i = 0; i < log.gnss.size(); ++i) {
      EXPECT_EQ(log.gnss[i].latitude_deg, complete.gnss[i].latitude_deg);
    }
  }
}

TEST(DataFlash, BytesLostFromOneRecordCostThatRecordAlone) {
  Rover4Writer head = Ready();
  head.Run(5);
  const std::size_t begin = head.size();
  Rover4Writer log = head;
  log.Gps(20'000'000, 0, 3, 999, 999).Run(5, 21'000'000);
  for (std::size_t lost = 1; lost < 51; ++lost) {
    Bytes bytes = log.Bytes();
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(begin);
    bytes.erase(first + static_cast<std::ptrdiff_t>(51 - lost), first + 51);
    const DataFlashLog read = ParseDataFlash(bytes, {});
    EXPECT_EQ(read.report.records.at("ATT"), 20u);
    // With one byte left of it, nothing confirms the record before it.
    EXPECT_EQ(read.report.records.at("RCOU"), lost == 50 ? 19u : 20u) << lost;
    EXPECT_EQ(read.gnss.size(), 10u);
    for (const GnssFix& fix : read.gnss) EXPECT_GT(fix.latitude_deg, 60.0);
    // With two left, they and the next header read as a header of type 0xA3.
    EXPECT_EQ(read.report.damage.corrupt_records, lost == 49 ? 0u : 1u) << lost;
    EXPECT_EQ(read.report.damage.undefined_records, lost == 49 ? 1u : 0u) << lost;
    EXPECT_GT(read.report.damage.skipped_bytes, 0u);
  }
}

/// One random injury: a flipped bit, bytes overwritten, removed, inserted or repeated, or a cut.
void CorruptBytes(Bytes& bytes, RandomEngine& draw) {
  if (bytes.empty()) return;
  const auto at = static_cast<std::ptrdiff_t>(draw() % bytes.size());
  const auto room = static_cast<std::uint64_t>(std::ssize(bytes) - at);
  const auto run = static_cast<std::ptrdiff_t>(1 + draw() % std::min<std::uint64_t>(room, 120));
  switch (draw() % 6) {
    case 0:
      bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1u << draw() % 8);
      break;
    case 1:
      std::generate_n(bytes.begin() + at, run, [&] { return static_cast<std::uint8_t>(draw()); });
      break;
    case 2: bytes.erase(bytes.begin() + at, bytes.begin() + at + run); break;
    case 3:
      bytes.insert(bytes.begin() + at, static_cast<std::size_t>(run),
                   static_cast<std::uint8_t>(draw()));
      break;
    case 4: {
      const Bytes repeated(bytes.begin() + at, bytes.begin() + at + run);
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(draw() % bytes.size()),
                   repeated.begin(), repeated.end());
      break;
    }
    case 5:
      if (draw() % 8 == 0) bytes.resize(static_cast<std::size_t>(at));
      break;
  }
}

TEST(DataFlash, CorruptedLogsAccountForEveryByteAndAddNoSamples) {
  const Bytes whole = Rover4Writer().WholeLog(15).Bytes();
  for (std::uint64_t trial = 0; trial < 4000; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    RandomEngine draw = RandomEngine::Stream(20260, trial);
    Bytes bytes = whole;
    for (std::uint64_t corruptions = 1 + draw() % 8; corruptions > 0; --corruptions)
      CorruptBytes(bytes, draw);

    const DataFlashLog log = ParseDataFlash(bytes, {});
    const DataFlashReport& report = log.report;
    EXPECT_EQ(report.bytes, bytes.size());
    EXPECT_LE(report.damage.skipped_bytes, bytes.size());
    EXPECT_LE(report.damage.truncated_bytes, report.damage.skipped_bytes);
    std::uint64_t records = 0;
    for (const auto& [name, count] : report.records) records += count;
    EXPECT_LE(3 * records + report.damage.skipped_bytes, bytes.size());
    EXPECT_LE(log.gnss.size() + log.heading.size() + log.thrusters.size(), records);
    EXPECT_FALSE(report.Summary().empty());
    (void)log.Lacks();
  }
}

TEST(DataFlash, FilesAreReadInBlocksWithTheSameOutcome) {
  const Bytes bytes = Rover4Writer().WholeLog(8000).Bytes();  // 1.5 MB, more than a block
  ASSERT_GT(bytes.size(), 1u << 20);
  const TemporaryFile file(bytes);
  const auto log = ReadDataFlash(file.path());
  ASSERT_TRUE(log);
  EXPECT_EQ(log->gnss.size(), 8000u);
  EXPECT_EQ(log->thrusters.size(), 16000u);
  EXPECT_EQ(log->report.bytes, bytes.size());
  EXPECT_EQ(log->report.damage, DataFlashDamage{});
}

TEST(DataFlash, RefusesFilesThatCannotBeUsed) {
  const auto absent = ReadDataFlash("no-such.BIN");
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().reason, HasSubstr("cannot be opened"));
  EXPECT_FALSE(ReadDataFlash(testing::TempDir()));  // a folder

  const TemporaryFile empty({});
  const auto nothing = ReadDataFlash(empty.path());
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().reason, HasSubstr("empty"));
  EXPECT_THAT(nothing.error().subject, HasSubstr(".BIN"));
}

TEST(DataFlashOptions, NamesTheFieldOutOfRange) {
  DataFlashOptions options;
  EXPECT_EQ(options.Validate(), std::nullopt);
  options.starboard_channel = 15;
  ASSERT_TRUE(options.Validate());
  EXPECT_EQ(options.Validate()->subject, "starboard_channel");
  EXPECT_THAT(options.Validate()->reason, AllOf(HasSubstr("15"), HasSubstr("[1, 14]")));
  options.port_channel = 0;
  EXPECT_EQ(options.Validate()->subject, "port_channel");
  options.gps_instance = -1;
  EXPECT_EQ(options.Validate()->subject, "gps_instance");
}

}  // namespace
}  // namespace telltale
