#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace telltale {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::size_t kGnss = 0;

const std::string kGnssFile = "time_s,latitude_deg,longitude_deg\n0,63.1,10.1\n0.2,63.2,10.2\n";
const std::string kHeadingFile = "time_s,heading_deg\n0,188.5\n0.1,188.6\n";
const std::string kThrusterFile = "time_s,left_us,right_us\n0,1510,1520\n0.1,1530,1540\n";

class TelemetryLogTest : public testing::Test {
 protected:
  TelemetryLogTest() {
    folder.Write("gnss.csv", kGnssFile);
    folder.Write("heading.csv", kHeadingFile);
    folder.Write("thrusters.csv", kThrusterFile);
  }

  Refusal ReadRefusal() const {
    const auto log = ReadTelemetryLog(folder.Path());
    if (!log) return log.error();
    return log->lacks.empty() ? Refusal{} : log->lacks.front();
  }

  Recording ReadRecording() const {
    const auto log = ReadTelemetryLog(folder.Path());
    EXPECT_TRUE(log) << log.error().subject << ' ' << log.error().reason;
    const auto admitted = Admit(log->channels);
    EXPECT_TRUE(admitted) << admitted.error().subject << ' ' << admitted.error().reason;
    return admitted ? admitted->recording : Recording{};
  }

  void ExpectTheGoodFixes() const {
    const Recording recording = ReadRecording();
    ASSERT_EQ(recording.gnss.size(), 2u);
    EXPECT_EQ(recording.gnss[1].time_s, 0.2);
    EXPECT_EQ(recording.gnss[1].latitude_deg, 63.2);
    EXPECT_EQ(recording.gnss[1].longitude_deg, 10.2);
  }

  TemporaryFolder folder;
};

TEST_F(TelemetryLogTest, ReadsTheThreeChannels) {
  ExpectTheGoodFixes();
  const Recording recording = ReadRecording();
  ASSERT_EQ(recording.heading.size(), 2u);
  EXPECT_EQ(recording.heading[0].heading_deg, 188.5);
  ASSERT_EQ(recording.thrusters.size(), 2u);
  EXPECT_EQ(recording.thrusters[1].port_us, 1530.0);
  EXPECT_EQ(recording.thrusters[1].starboard_us, 1540.0);
  EXPECT_EQ(recording.rejected.Total(), 0u);
}

TEST_F(TelemetryLogTest, ThinsWhatOutgrowsItsMemoryAndSaysSo) {
  std::string rows = "time_s,heading_deg\n";
  for (int ms = 0; ms < 60'000; ++ms) rows += std::to_string(ms) + "e-3,188.5\n";
  folder.Write("heading.csv", rows);
  const auto log = ReadTelemetryLog(folder.Path(), 80'000);
  ASSERT_TRUE(log);
  EXPECT_EQ(log->channels.heading.size(), 60u * 50u);
  EXPECT_EQ(log->channels.gnss.size(), 2u);
  EXPECT_THAT(log->left_out, testing::HasSubstr("thinned by whole samples to 50 Hz"));
}

TEST_F(TelemetryLogTest, GivesTheRawSamples) {
  const auto log = ReadTelemetryLog(folder.Path());
  ASSERT_TRUE(log);
  std::vector<double> times;
  for (const RawSample& sample : InOrderOfTime(log->channels)) times.push_back(TimeOf(sample));
  EXPECT_THAT(times, ElementsAre(0, 0, 0, 0.1, 0.1, 0.2));
}

TEST_F(TelemetryLogTest, ToleratesCrlfSpacesBlankLinesExtraAndReorderedColumns) {
  folder.Write("gnss.csv",
               "\xef\xbb\xbf longitude_deg , satellites, time_s,latitude_deg\r\n"
               "\r\n"
               "10.1, 12, 0, 63.1\r\n"
               "  \n"
               " +10.2 ,many,\t2e-1,63.2 , surplus\r\n"
               "\n");
  ExpectTheGoodFixes();
  EXPECT_EQ(ReadTelemetryLog(folder.Path())->malformed[kGnss].count, 0u);
}

TEST_F(TelemetryLogTest, TheLastLineNeedsNoLineEnd) {
  folder.Write("gnss.csv", kGnssFile.substr(0, kGnssFile.size() - 1));
  ExpectTheGoodFixes();
}

TEST_F(TelemetryLogTest, CountsMalformedRowsAndNamesTheFirstLines) {
  folder.Write("gnss.csv",
               "time_s,latitude_deg,longitude_deg\n"
               "0,63.1,10.1\n"
               "0.05,63.1\n"        // 3: a column short
               "0.06,,10.1\n"       // 4: an empty cell
               "0.07,63.1,10.1x\n"  // 5: not a number
               "0.08,63,1,10,1\n"   // a decimal comma shifts columns: longitude 1 is a number
               "0.2,63.2,10.2\n"
               "garbage\n"            // 8
               "0.3,1e999,10\n"       // 9: no double
               "0.4,0x10,10\n"        // 10
               "\xff\xfe,\x01,2\n");  // 11
  const auto log = ReadTelemetryLog(folder.Path());
  ASSERT_TRUE(log);
  EXPECT_EQ(log->malformed[kGnss].count, 7u);
  EXPECT_THAT(log->malformed[kGnss].first_lines, ElementsAre(3, 4, 5, 8, 9));
}

TEST_F(TelemetryLogTest, WrongSamplesAreCountedByReasonAndLeftOut) {
  folder.Write("gnss.csv",
               "time_s,latitude_deg,longitude_deg\n"
               "0,63.1,10.1\n"
               "0.05,nan,10.1\n"
               "inf,63.1,10.1\n"
               "0.1,91,10.1\n"
               "0.2,63.2,10.2\n"
               "0.2,63.2,10.2\n");
  ExpectTheGoodFixes();
  const RejectCounts rejected = ReadRecording().rejected;
  EXPECT_EQ(rejected.Of(Channel::kGnss, RejectReason::kNotFinite), 2u);
  EXPECT_EQ(rejected.Of(Channel::kGnss, RejectReason::kOutOfRange), 1u);
  EXPECT_EQ(rejected.Of(Channel::kGnss, RejectReason::kDuplicate), 1u);
  EXPECT_EQ(rejected.Total(), 4u);
}

TEST_F(TelemetryLogTest, AMissingFileIsNamed) {
  std::filesystem::remove(folder.Path() / "heading.csv");
  EXPECT_THAT(ReadRefusal().subject, HasSubstr("heading.csv"));
  EXPECT_THAT(ReadRefusal().reason, HasSubstr("missing"));
}

TEST_F(TelemetryLogTest, AMissingFolderIsNamed) {
  const auto log = ReadTelemetryLog(folder.Path() / "nowhere");
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().subject, HasSubstr("nowhere"));
  EXPECT_FALSE(ReadTelemetryLog(folder.Path() / "gnss.csv"));
}

TEST_F(TelemetryLogTest, AFolderInPlaceOfAFileIsNamed) {
  std::filesystem::remove(folder.Path() / "gnss.csv");
  std::filesystem::create_directory(folder.Path() / "gnss.csv");
  EXPECT_THAT(ReadRefusal().reason, HasSubstr("folder"));
}

TEST_F(TelemetryLogTest, EmptyFilesAreRefused) {
  for (const char* content : {"", "\n\n \r\n", "\xef\xbb\xbf"}) {
    folder.Write("thrusters.csv", content);
    EXPECT_THAT(ReadRefusal().subject, HasSubstr("thrusters.csv"));
    EXPECT_THAT(ReadRefusal().reason, HasSubstr("empty"));
  }
}

TEST_F(TelemetryLogTest, AHeaderWithoutAColumnIsRefusedSayingWhichAreNeeded) {
  folder.Write("thrusters.csv", "time_s,left_us,right\n0,1500,1500\n");
  EXPECT_THAT(ReadRefusal().reason, HasSubstr("time_s,left_us,right"));
  EXPECT_THAT(ReadRefusal().advice, HasSubstr("time_s,left_us,right_us"));
}

TEST_F(TelemetryLogTest, AFileWithoutAReadableRowIsRefused) {
  folder.Write("heading.csv", "time_s,heading_deg\n");
  EXPECT_THAT(ReadRefusal().reason, HasSubstr("a header and no row"));
  folder.Write("heading.csv", "time_s,heading_deg\na,b\nc,d\n");
  EXPECT_THAT(ReadRefusal().reason, HasSubstr("no usable row, only 2 malformed rows"));
}

TEST_F(TelemetryLogTest, AChannelOfWrongValuesIsRefusedWithTheReasons) {
  folder.Write("heading.csv", "time_s,heading_deg\n0,nan\n0.1,9999\n");
  const auto admitted = Admit(ReadTelemetryLog(folder.Path())->channels);
  ASSERT_FALSE(admitted);
  EXPECT_EQ(admitted.error().subject, "heading");
  EXPECT_THAT(admitted.error().reason, HasSubstr("1 NOT_FINITE, 1 OUT_OF_RANGE"));
}

TEST_F(TelemetryLogTest, BinaryRubbishIsRefusedNotCrashedOn) {
  std::string rubbish;
  for (int i = 0; i < 100000; ++i) rubbish += static_cast<char>(i * 7919 >> 3);
  folder.Write("gnss.csv", rubbish);
  EXPECT_THAT(ReadRefusal().subject, HasSubstr("gnss.csv"));
  folder.Write("gnss.csv", kGnssFile + rubbish);
  ExpectTheGoodFixes();
}

TEST_F(TelemetryLogTest, WrittenAndReadAgainIsTheSame) {
  constexpr int kSamples = 5000;  // more than is written at once
  Recording written;
  for (int i = 0; i < kSamples; ++i) {
    const double t = 1700000000.0 + 0.2 * i;
    written.gnss.push_back({t, 37.4205 + 1e-9 * i * i, -5.9944 - 1e-7 * i});
    written.heading.push_back({t + 0.02, std::fmod(3.25 * i, 360.0)});
    written.thrusters.push_back({t + 0.1, 1500.0 + 0.1 * i, 1500.5 - 0.1 * i});
  }
  WriteTelemetryLog(folder.Path() / "a" / "log", written);
  const auto log = ReadTelemetryLog(folder.Path() / "a" / "log");
  ASSERT_TRUE(log) << log.error().reason;
  const auto admitted = Admit(log->channels);
  ASSERT_TRUE(admitted) << admitted.error().reason;
  EXPECT_EQ(admitted->recording.rejected.Total(), 0u);
  EXPECT_EQ(admitted->evicted, 0u);
  ASSERT_EQ(admitted->recording.gnss.size(), written.gnss.size());
  for (std::size_t i = 0; i < written.gnss.size(); ++i) {
    EXPECT_EQ(admitted->recording.gnss[i].time_s, written.gnss[i].time_s);
    // Half of the last decimal written.
    EXPECT_NEAR(admitted->recording.gnss[i].latitude_deg, written.gnss[i].latitude_deg, 0.51e-9);
    EXPECT_NEAR(admitted->recording.gnss[i].longitude_deg, written.gnss[i].longitude_deg, 0.51e-9);
    EXPECT_EQ(admitted->recording.heading[i].heading_deg, written.heading[i].heading_deg);
    EXPECT_NEAR(admitted->recording.thrusters[i].port_us, written.thrusters[i].port_us, 0.51e-3);
    EXPECT_NEAR(admitted->recording.thrusters[i].starboard_us, written.thrusters[i].starboard_us,
                0.51e-3);
  }
}

TEST_F(TelemetryLogTest, AFolderThatCannotBeWrittenThrows) {
  EXPECT_THROW(WriteTelemetryLog(folder.Path() / "gnss.csv" / "log", {}), std::system_error);
}

TEST_F(TelemetryLogTest, SamplesOlderThanADayAreEvictedAndCounted) {
  folder.Write("heading.csv", "time_s,heading_deg\n0,1\n86000,2\n86300,3\n86420,4\n");
  std::string gnss = "time_s,latitude_deg,longitude_deg\n";
  std::string thrusters = "time_s,left_us,right_us\n";
  for (int t = 0; t <= 86430; t += 30) {
    gnss += std::to_string(t) + ",1,1\n";
    thrusters += std::to_string(t) + ",1500,1500\n";
  }
  folder.Write("gnss.csv", gnss);
  folder.Write("thrusters.csv", thrusters);
  const auto admitted = Admit(ReadTelemetryLog(folder.Path())->channels);
  ASSERT_TRUE(admitted) << admitted.error().reason;
  EXPECT_EQ(admitted->evicted, 3u);  // time 0 of each channel
}

// ---- several logs ------------------------------------------------------------------------------

Recording Starting(double start_s) {
  Recording recording;
  for (int i = 0; i < 3; ++i) {
    recording.gnss.push_back({start_s + i, 0.0, 0.0});
    recording.heading.push_back({start_s + i, 0.0});
    recording.thrusters.push_back({start_s + i, 1500.0, 1500.0});
  }
  return recording;
}

double StartOfSecond(double first_start_s, double second_start_s) {
  const std::vector<Recording> recordings = {Starting(first_start_s), Starting(second_start_s)};
  const Recording all = Concatenate(recordings);
  EXPECT_EQ(all.gnss.size(), 6u);
  EXPECT_EQ(all.heading[3].time_s, all.gnss[3].time_s);
  EXPECT_EQ(all.thrusters[5].time_s, all.gnss[5].time_s);
  EXPECT_EQ(all.gnss.front().time_s, first_start_s);
  return all.gnss[3].time_s;
}

TEST(Concatenate, KeepsTheTimesOfALogThatFollowsWithinADay) {
  EXPECT_EQ(StartOfSecond(1000.0, 1500.0), 1500.0);
}

TEST(Concatenate, ShiftsALogThatOverlapsPrecedesOrIsFarAway) {
  const double expected_s = 1002.0 + kGapBetweenLogsS;
  for (const double start_s : {1000.0, 1001.5, 1010.0, 0.0, 1.7e9}) {
    EXPECT_EQ(StartOfSecond(1000.0, start_s), expected_s) << start_s;
  }
}

TEST(Concatenate, KeepsWhereEachLogBegins) {
  const std::vector<Recording> recordings = {Starting(1000.0), Starting(1500.0), Starting(0.0)};
  EXPECT_EQ(Concatenate(recordings).starts_s,
            (std::vector<double>{1000.0, 1500.0, 1502.0 + kGapBetweenLogsS}));
}

TEST(Concatenate, AddsUpWhatWasRejected) {
  std::vector<Recording> recordings = {Starting(0.0), Starting(0.0)};
  recordings[0].rejected.Count(Channel::kGnss, RejectReason::kDuplicate, 2);
  recordings[1].rejected.Count(Channel::kGnss, RejectReason::kDuplicate, 3);
  EXPECT_EQ(Concatenate(recordings).rejected.Of(RejectReason::kDuplicate), 5u);
}

// ---- commands
// ------------------------------------------------------------------------------------

TEST_F(TelemetryLogTest, CommandsAreAThrustersFileAlone) {
  const auto file = folder.Write("c.csv",
                                 "time_s,left_us,right_us\n0,1500,1600\n1,x,1500\n"
                                 "2,9999,1500\n3,1700,1800\n");
  const auto log = ReadCommands(file);
  ASSERT_TRUE(log);
  ASSERT_EQ(log->commands.size(), 2u);
  EXPECT_EQ(log->commands[1].time_s, 3.0);
  EXPECT_EQ(log->commands[1].port_us, 1700.0);
  EXPECT_EQ(log->malformed.count, 1u);
  EXPECT_EQ(log->rejected.Of(RejectReason::kOutOfRange), 1u);
}

TEST_F(TelemetryLogTest, CommandsWithoutAUsableRowAreRefused) {
  EXPECT_FALSE(ReadCommands(folder.Path() / "missing.csv"));
  const auto file = folder.Write("c.csv", "time_s,left_us,right_us\n0,9999,1600\n");
  const auto log = ReadCommands(file);
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().reason, HasSubstr("1 OUT_OF_RANGE"));
}

}  // namespace
}  // namespace telltale
