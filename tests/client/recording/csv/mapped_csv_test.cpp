#include "telltale/client/recording/csv/mapped_csv.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/load_recording.hpp"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kMap =
    "time { field: \"t\" }\n"
    "positions { latitude: \"Lat (deg)\" longitude: \"Lon (deg)\" }\n"
    "headings { field: \"yaw\" unit: \"rad\" }\n"
    "port { field: \"l\" unit: \"share\" } starboard { field: \"r\" unit: \"share\" }\n";

class MappedCsvTest : public testing::Test {
 protected:
  Result<SourceLog> Read(const std::string& text, const std::string& map = kMap) {
    std::ofstream(Csv()) << text;
    const auto mapping = ParseMapping(map);
    if (!mapping) throw std::runtime_error(mapping.error().Message());
    return ReadMappedCsv(Csv(), *mapping);
  }
  std::filesystem::path Csv() const { return folder_.Path() / "run.csv"; }

  TemporaryFolder folder_;
};

TEST_F(MappedCsvTest, ReadsColumnsOfAnyNameAndRate) {
  const auto log = Read(
      "\xef\xbb\xbfr,t,extra,\"Lat (deg)\",Lon (deg),yaw,l\r\n"
      "0.5,0,x,63.4,10.4,0,0.25\r\n"
      "0.5,0.1,,,,0.5,0.25\r\n"
      "\r\n"
      "-1,0.2,,,,bad,1\r\n");
  ASSERT_TRUE(log) << log.error().reason;
  ASSERT_EQ(log->gnss.size(), 1u);
  EXPECT_EQ(log->gnss[0].longitude_deg, 10.4);
  ASSERT_EQ(log->heading.size(), 2u);
  EXPECT_NEAR(log->heading[1].heading_deg, 28.6479, 1e-4);
  ASSERT_EQ(log->thrusters.size(), 3u);
  EXPECT_EQ(log->thrusters[2].time_s, 0.2);
  EXPECT_EQ(log->thrusters[2].port_us, 1900.0);
  EXPECT_EQ(log->thrusters[2].starboard_us, 1100.0);
  EXPECT_THAT(log->summary, HasSubstr("1 rows without a heading"));
}

TEST_F(MappedCsvTest, UnderstandsSemicolonsWithDecimalCommas) {
  const auto log = Read("t;Lat (deg);Lon (deg);yaw;l;r\n0,5;63,4;10,4;1,5;0,5;-0,5");
  ASSERT_TRUE(log) << log.error().reason;
  EXPECT_EQ(log->gnss.at(0).latitude_deg, 63.4);
  EXPECT_EQ(log->thrusters.at(0).time_s, 0.5);
}

TEST_F(MappedCsvTest, UnderstandsIsoTimesAndNaNForNothing) {
  const auto log = Read(
      "t,Lat (deg),Lon (deg),yaw,l,r\n"
      "2023-11-14 22:13:20.250+00:00,63.4,10.4,NaN,0,0\n"
      "2023-11-14 22:13:20.500+00:00,nan,nan,1.5,nan,\n");
  ASSERT_TRUE(log) << log.error().reason;
  ASSERT_EQ(log->gnss.size(), 1u);
  EXPECT_EQ(log->gnss[0].time_s, 1700000000.25);
  ASSERT_EQ(log->heading.size(), 1u);
  EXPECT_EQ(log->heading[0].time_s, 1700000000.5);
  EXPECT_EQ(log->thrusters.size(), 1u);
}

TEST_F(MappedCsvTest, TakesMetresFromAnyOrigin) {
  const auto log = Read("t,x,y,yaw,l,r\n0,0,0,0,0,0\n1,30,40,0,0,0\n",
                        "time { field: \"t\" } positions { north: \"y\" east: \"x\" }"
                        "headings { field: \"yaw\" }"
                        "port { field: \"l\" unit: \"share\" }"
                        "starboard { field: \"r\" unit: \"share\" }");
  ASSERT_TRUE(log) << log.error().reason;
  ASSERT_EQ(log->gnss.size(), 2u);
  // A degree of a meridian at 45 degrees north is 111 132 m long, one of the parallel 78 847 m.
  EXPECT_NEAR((log->gnss[1].latitude_deg - log->gnss[0].latitude_deg) * 111132.0, 40.0, 0.01);
  EXPECT_NEAR((log->gnss[1].longitude_deg - log->gnss[0].longitude_deg) * 78847.0, 30.0, 0.01);
  EXPECT_THAT(log->summary, HasSubstr("metres from an origin that is not stated"));
}

TEST_F(MappedCsvTest, KeepsSidesTogetherWhereTheClockIsSetBack) {
  std::string text = "t,Lat (deg),Lon (deg),yaw,l,r\n";
  for (const double t : {1000.0, 1001.0, 5.0, 6.0}) {
    text += std::to_string(t) + ",63.4,10.4,0,0.25," + (t > 500.0 ? "0.5\n" : "-0.5\n");
  }
  const auto log = Read(text);
  ASSERT_TRUE(log) << log.error().reason;
  ASSERT_EQ(log->thrusters.size(), 4u);
  for (const ThrusterSample& sample : log->thrusters) {
    EXPECT_EQ(sample.port_us, 1600.0) << sample.time_s;
    EXPECT_EQ(sample.starboard_us, sample.time_s > 500.0 ? 1700.0 : 1300.0) << sample.time_s;
  }
}

TEST_F(MappedCsvTest, SaysWhatIsMissing) {
  const auto column = Read("t,lat,Lon (deg),yaw,l,r\n0,1,2,3,0,0\n");
  ASSERT_FALSE(column);
  EXPECT_THAT(column.error().reason, AllOf(HasSubstr("Lat (deg)"), HasSubstr("t, lat, Lon (deg)")));
  const auto empty = Read("");
  ASSERT_FALSE(empty);
  EXPECT_THAT(empty.error().reason, HasSubstr("is empty"));
  const auto no_rows = Read("t,Lat (deg),Lon (deg),yaw,l,r\n");
  ASSERT_TRUE(no_rows);
  EXPECT_EQ(no_rows->Lacks().size(), 3u);
  const std::string timeless =
      "positions { latitude: \"a\" longitude: \"b\" } headings { field: \"c\" } "
      "port { field: \"d\" } starboard { field: \"e\" }";
  const auto no_time = Read("a,b,c,d,e\n", timeless);
  ASSERT_FALSE(no_time);
  EXPECT_THAT(no_time.error().reason, HasSubstr("names no column of times"));
}

/// One CSV of the sample, resampled by nobody: each row holds one channel.
TEST_F(MappedCsvTest, GivesEveryCommandWhatTheFolderGives) {
  const auto sample = LoadRecording(std::filesystem::path(TELLTALE_SOURCE_DIR) / "deploy/sample");
  ASSERT_TRUE(sample);
  {
    std::ofstream csv(Csv());
    csv.precision(17);
    csv << "ms,lat,lon,enu,left,right\n";
    for (const GnssFix& fix : sample->recording.gnss) {
      csv << fix.time_s * 1e3 << ',' << fix.latitude_deg << ',' << fix.longitude_deg << ",,,\n";
    }
    for (const HeadingSample& one : sample->recording.heading) {
      csv << one.time_s * 1e3 << ",,," << 90.0 - one.heading_deg << ",,\n";
    }
    for (const ThrusterSample& one : sample->recording.thrusters) {
      csv << one.time_s * 1e3 << ",,,," << (one.port_us - 1500.0) / 4.0 << ','
          << (one.starboard_us - 1500.0) / 4.0 << '\n';
    }
  }
  const std::string map = (folder_.Path() / "map.textproto").string();
  std::ofstream(map) << "time { field: \"ms\" unit: \"ms\" }\n"
                        "positions { latitude: \"lat\" longitude: \"lon\" }\n"
                        "headings { field: \"enu\" frame: \"ENU\" }\n"
                        "port { field: \"left\" unit: \"percent\" }\n"
                        "starboard { field: \"right\" unit: \"percent\" }\n";
  const std::string vehicle =
      (std::filesystem::path(TELLTALE_SOURCE_DIR) / "deploy/sample/yellowfish.textproto").string();
  const std::string imported = (folder_.Path() / "imported").string();
  const CommandOutcome import =
      Telltale({"import", "--log", Csv().string(), "--map", map, "--out", imported});
  ASSERT_EQ(import.exit_code, kExitSuccess) << import.err;
  EXPECT_THAT(import.err, HasSubstr("heading from enu, east-north-up"));
  const auto read = LoadRecording(imported);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->recording.gnss.size(), sample->recording.gnss.size());
  ASSERT_EQ(read->recording.heading.size(), sample->recording.heading.size());
  ASSERT_EQ(read->recording.thrusters.size(), sample->recording.thrusters.size());
  for (std::size_t i = 0; i < sample->recording.thrusters.size(); ++i) {
    EXPECT_NEAR(read->recording.thrusters[i].port_us, sample->recording.thrusters[i].port_us, 1e-3);
    EXPECT_NEAR(read->recording.thrusters[i].time_s, sample->recording.thrusters[i].time_s, 1e-8);
  }
  const CommandOutcome check =
      Telltale({"check", "--log", Csv().string(), "--map", map, "--vehicle", vehicle});
  EXPECT_EQ(check.exit_code, kExitSuccess) << check.out << check.err;
  const CommandOutcome folder = Telltale({"check", "--log", imported, "--map", map});
  EXPECT_EQ(folder.exit_code, kExitRefused);
  EXPECT_THAT(folder.err, HasSubstr("leave out --map"));
}

}  // namespace
}  // namespace telltale
