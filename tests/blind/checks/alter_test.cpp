#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "alter/alterations.hpp"
#include "support/run_command.hpp"
#include "support/temporary_folder.hpp"

namespace blind::alter {
namespace {

using telltale::TemporaryFolder;
using telltale::TextOfFile;

constexpr double kMetresPerDegree = 111132.0;  // of latitude, near enough for the differences here

Telemetry SmallLog() {
  return {.fixes = {{10.0, 45.0, 7.0}, {11.0, 45.0, 7.0}, {12.5, 45.0, 7.0}},
          .headings = {{10.0, 350.0}, {11.0, 10.0}, {12.0, 90.0}},
          .pulses = {{10.0, 1700, 1500}, {10.1, 1900, 1300}, {10.2, 1340, 1100}},
          .rows_left_out = 0};
}

TEST(TurnHeading, WrapsAtNorth) {
  Telemetry log = SmallLog();
  TurnHeading(log, 12.0);
  EXPECT_DOUBLE_EQ(log.headings[0].heading_deg, 2.0);
  EXPECT_DOUBLE_EQ(log.headings[1].heading_deg, 22.0);
  TurnHeading(log, -4.0);
  EXPECT_DOUBLE_EQ(log.headings[0].heading_deg, 358.0);
}

TEST(DelayFixes, StampsThemLater) {
  Telemetry log = SmallLog();
  DelayFixes(log, 0.4);
  EXPECT_DOUBLE_EQ(log.fixes[0].time_s, 10.4);
  EXPECT_DOUBLE_EQ(log.headings[0].time_s, 10.0);
  EXPECT_DOUBLE_EQ(log.pulses[0].time_s, 10.0);
}

TEST(ShiftCommands, StampsThemEarlier) {
  Telemetry log = SmallLog();
  ShiftCommands(log, 0.3);
  EXPECT_DOUBLE_EQ(log.pulses[0].time_s, 9.7);
  EXPECT_DOUBLE_EQ(log.fixes[0].time_s, 10.0);
}

TEST(MoveAntenna, TurnsTheLeverWithTheHeading) {
  Telemetry log = SmallLog();
  log.headings = {{10.0, 0.0}, {11.0, 90.0}, {12.0, 180.0}, {13.0, 180.0}};
  EXPECT_EQ(MoveAntenna(log, 2.0, 1.0), 0u);
  // Heading north: forward is north, starboard is east.
  EXPECT_NEAR((log.fixes[0].latitude_deg - 45.0) * kMetresPerDegree, 2.0, 0.01);
  EXPECT_NEAR((log.fixes[0].longitude_deg - 7.0) * kMetresPerDegree * std::sqrt(0.5), 1.0, 0.01);
  // Heading east: forward is east, starboard is south.
  EXPECT_NEAR((log.fixes[1].latitude_deg - 45.0) * kMetresPerDegree, -1.0, 0.01);
  EXPECT_NEAR((log.fixes[1].longitude_deg - 7.0) * kMetresPerDegree * std::sqrt(0.5), 2.0, 0.01);
  // Heading south.
  EXPECT_NEAR((log.fixes[2].latitude_deg - 45.0) * kMetresPerDegree, -2.0, 0.01);
}

TEST(MoveAntenna, InterpolatesTheShortWayRoundAndDropsFixesOutside) {
  Telemetry log = SmallLog();
  log.fixes[0].time_s = 10.5;  // between 350 and 10 degrees: north
  EXPECT_EQ(MoveAntenna(log, 1.0, 0.0), 1u) << "12.5 s is after the last heading";
  ASSERT_EQ(log.fixes.size(), 2u);
  EXPECT_NEAR((log.fixes[0].latitude_deg - 45.0) * kMetresPerDegree, 1.0, 0.01);
  EXPECT_NEAR(log.fixes[0].longitude_deg, 7.0, 1e-12);
}

TEST(Weaken, AsksMoreOfTheWeakerSide) {
  Telemetry log = SmallLog();
  // Three quarters lost: twice the command for the same thrust.
  EXPECT_EQ(Weaken(log, Side::kPort, 0.75, {1500, 1900, 1100}), 1u);
  EXPECT_DOUBLE_EQ(log.pulses[0].left_us, 1900.0);  // 0.5 becomes 1
  EXPECT_DOUBLE_EQ(log.pulses[1].left_us, 1900.0);  // 1 would need 2, and is cut
  EXPECT_DOUBLE_EQ(log.pulses[2].left_us, 1180.0);  // -0.4 becomes -0.8
  EXPECT_DOUBLE_EQ(log.pulses[0].right_us, 1500.0);
}

TEST(Weaken, FollowsTheThrustCurve) {
  Telemetry log = SmallLog();
  log.pulses = {{10.0, 1700, 1500}, {10.1, 1320, 1500}, {10.2, 1530, 1500}};
  const ThrustCurve curve{.forward_linear = 1.0,
                          .forward_quadratic = 2.0,
                          .reverse_linear = 0.5,
                          .reverse_quadratic = 0.0,
                          .forward_dead_band = 0.1,
                          .reverse_dead_band = 0.1};
  EXPECT_EQ(Weaken(log, Side::kPort, 0.5, {1500, 1900, 1100}, curve), 0u);
  // e = 0.4 gives 0.72; twice that is e + 2 e^2 at e = (sqrt(12.52) - 1) / 4.
  EXPECT_NEAR(log.pulses[0].left_us, 1500.0 + 400.0 * (0.1 + (std::sqrt(12.52) - 1.0) / 4.0), 1e-9);
  EXPECT_NEAR(log.pulses[1].left_us, 1500.0 - 400.0 * (0.1 + 2.0 * 0.35), 1e-9);
  EXPECT_DOUBLE_EQ(log.pulses[2].left_us, 1530.0);  // within the dead band
}

TEST(Weaken, KnowsReversedChannels) {
  Telemetry log = SmallLog();
  log.pulses = {{10.0, 1500, 1411}, {10.1, 1500, 1611}};
  // As on a boat whose starboard channel runs from 1911 us astern to 1111 us ahead.
  EXPECT_EQ(Weaken(log, Side::kStarboard, 0.36, {1511, 1111, 1911}), 0u);
  EXPECT_DOUBLE_EQ(log.pulses[0].right_us, 1386.0);  // 0.25 becomes 0.3125
  EXPECT_DOUBLE_EQ(log.pulses[1].right_us, 1636.0);  // -0.25 becomes -0.3125
}

TEST(Telemetry, ReadsWhatItWrote) {
  const TemporaryFolder folder;
  const Telemetry log = SmallLog();
  WriteTelemetry(log, folder.Path() / "log");
  const Telemetry again = ReadTelemetry(folder.Path() / "log");
  ASSERT_EQ(again.fixes.size(), 3u);
  EXPECT_NEAR(again.fixes[2].time_s, 12.5, 1e-6);
  EXPECT_NEAR(again.fixes[2].latitude_deg, 45.0, 1e-10);
  EXPECT_EQ(again.headings.size(), 3u);
  EXPECT_NEAR(again.pulses[2].left_us, 1340.0, 1e-3);
}

TEST(Telemetry, LeavesOutRowsThatAreNoNumbers) {
  const TemporaryFolder folder;
  WriteTelemetry(SmallLog(), folder.Path());
  folder.Write("heading.csv", "time_s,heading_deg\r\n1,20\r\n2\n3,x\n4,50,6\n5,60\n");
  const Telemetry log = ReadTelemetry(folder.Path());
  EXPECT_EQ(log.headings.size(), 2u);
  EXPECT_EQ(log.rows_left_out, 3u);
}

TEST(Telemetry, NamesTheFileThatCannotBeRead) {
  const TemporaryFolder folder;
  WriteTelemetry(SmallLog(), folder.Path());
  folder.Write("thrusters.csv", "time,left,right\n");
  EXPECT_THAT([&] { ReadTelemetry(folder.Path()); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("thrusters.csv")));
  EXPECT_THAT([&] { ReadTelemetry(folder.Path() / "00000042.BIN"); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr(".BIN")));
}

}  // namespace
}  // namespace blind::alter
