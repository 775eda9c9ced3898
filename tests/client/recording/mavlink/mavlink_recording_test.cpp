#include "telltale/client/recording/mavlink/mavlink_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

void NameOutputs(MavlinkRecording& recording, int system) {
  recording.Take(system, MavlinkParamValue{"SERVO1_FUNCTION", 73.0F});
  recording.Take(system, MavlinkParamValue{"SERVO3_FUNCTION", 74.0F});
}

MavlinkServoOutputRaw OutputAt(std::uint32_t time_us, std::uint16_t port, std::uint16_t starboard) {
  MavlinkServoOutputRaw output;
  output.time_us = time_us;
  output.pulse_us[0] = port;
  output.pulse_us[2] = starboard;
  return output;
}

TEST(MavlinkRecording, TakesThreeChannelsOnTheAutopilotsClock) {
  MavlinkRecording recording;
  NameOutputs(recording, 1);
  recording.Take(1, MavlinkGpsRawInt{2000000, 63.4, 10.4, 3});
  recording.Take(1, MavlinkAttitude{2500, 0.5F});
  recording.Take(1, OutputAt(3000000, 1600, 1400));
  const SourceLog log = std::move(recording).Finish({});
  ASSERT_TRUE(log.Lacks().empty()) << log.summary;
  EXPECT_DOUBLE_EQ(log.gnss.at(0).time_s, 2.0);
  EXPECT_DOUBLE_EQ(log.heading.at(0).time_s, 2.5);
  EXPECT_NEAR(log.heading.at(0).heading_deg, 28.6478898, 1e-5);
  EXPECT_DOUBLE_EQ(log.thrusters.at(0).time_s, 3.0);
  EXPECT_DOUBLE_EQ(log.thrusters.at(0).port_us, 1600.0);
  EXPECT_DOUBLE_EQ(log.thrusters.at(0).starboard_us, 1400.0);
}

TEST(MavlinkRecording, RefusesTheOutputOfPortForStarboard) {
  MavlinkRecording recording;
  NameOutputs(recording, 1);
  recording.Take(1, OutputAt(3000000, 1600, 1400));
  SourceOptions options;
  options.starboard_channel = 1;
  const SourceLog log = std::move(recording).Finish(options);
  EXPECT_TRUE(log.thrusters.empty());
  EXPECT_EQ(log.Lacks().back().subject, "starboard_channel");
  EXPECT_EQ(log.Lacks().back().reason, "output 1 stands for both thrusters");
}

TEST(MavlinkRecording, ThinsWhatOutgrowsItsMemoryAndSaysSo) {
  constexpr std::size_t kMost = 100'000;
  MavlinkRecording recording(kMost);
  NameOutputs(recording, 1);
  for (std::uint32_t ms = 0; ms < 60'000; ++ms) {  // a minute of attitudes at 1 kHz
    recording.Take(1, MavlinkAttitude{ms, 0.5F});
    if (ms % 100 == 0) recording.Take(1, OutputAt(1000 * ms, 1600, 1400));
    if (ms % 200 == 0) recording.Take(1, MavlinkGpsRawInt{1000 * ms, 63.4, 10.4, 3});
  }
  const SourceLog log = std::move(recording).Finish({});
  EXPECT_EQ(log.gnss.size(), 300u);
  EXPECT_EQ(log.thrusters.size(), 600u);
  EXPECT_EQ(log.heading.size(), 60u * 50u);
  EXPECT_THAT(log.summary, testing::HasSubstr("thinned by whole samples to 50 Hz"));
}

TEST(MavlinkRecording, CountsOneFixThatIsSentTwiceOnce) {
  MavlinkRecording recording;
  recording.Take(1, MavlinkGpsRawInt{2000000, 63.4, 10.4, 3});
  recording.Take(1, MavlinkGpsRawInt{2000000, 63.4, 10.4, 3});
  recording.Take(1, MavlinkGpsRawInt{2200000, 0.0, 0.0, 1});
  const SourceLog log = std::move(recording).Finish({});
  EXPECT_EQ(log.gnss.size(), 1u);
  EXPECT_THAT(log.summary, testing::HasSubstr("1 positions without a fix"));
  EXPECT_THAT(log.summary, testing::HasSubstr("1 positions sent again"));
}

TEST(MavlinkRecording, GoesOnWhereTheClockOfOutputsBeginsAnew) {
  MavlinkRecording recording;
  NameOutputs(recording, 1);
  recording.Take(1, OutputAt(4294900000u, 1500, 1500));
  recording.Take(1, OutputAt(32704u, 1500, 1500));  // 0.1 s later: 2^32 us have passed
  const SourceLog log = std::move(recording).Finish({});
  ASSERT_EQ(log.thrusters.size(), 2u);
  EXPECT_NEAR(log.thrusters[1].time_s - log.thrusters[0].time_s, 0.1, 1e-6);
}

TEST(MavlinkRecording, KeepsOutputsBesideTheOthersWhereTheAutopilotBootsAgain) {
  MavlinkRecording recording;
  NameOutputs(recording, 1);
  recording.Take(1, MavlinkAttitude{4300000, 0.0F});  // beyond the 4295 s that the counter holds
  recording.Take(1, OutputAt(5032704u, 1500, 1500));
  recording.Take(1, MavlinkAttitude{2000, 0.0F});
  recording.Take(1, OutputAt(2000000u, 1500, 1500));
  const SourceLog log = std::move(recording).Finish({});
  ASSERT_EQ(log.thrusters.size(), 2u);
  EXPECT_NEAR(log.thrusters[0].time_s, 4300.0, 1e-6);
  EXPECT_NEAR(log.thrusters[1].time_s, 2.0, 1e-6);
}

TEST(MavlinkRecording, BringsUnixFixesToTheAutopilotsClock) {
  MavlinkRecording recording;
  recording.Take(1, MavlinkSystemTime{1700000000000000, 50000});
  recording.Take(1, MavlinkGpsRawInt{1700000010000000, 63.4, 10.4, 3});
  EXPECT_NEAR(std::move(recording).Finish({}).gnss.at(0).time_s, 60.0, 1e-6);
}

TEST(MavlinkRecording, ChoosesTheVehicleThatSaysMostUnlessToldOtherwise) {
  const auto headings = [](std::optional<int> system) {
    MavlinkRecording recording;
    recording.Take(2, MavlinkAttitude{1000, 0.0F});
    recording.Take(9, MavlinkAttitude{1000, 1.0F});
    recording.Take(9, MavlinkAttitude{1100, 1.0F});
    SourceOptions options;
    options.system_id = system;
    return std::move(recording).Finish(options).heading.size();
  };
  EXPECT_EQ(headings(std::nullopt), 2u);
  EXPECT_EQ(headings(2), 1u);
}

TEST(MavlinkRecording, TakesTheComponentThatReportsOutputs) {
  MavlinkRecording recording;
  constexpr int kGimbal = 154;
  for (std::uint32_t i = 0; i < 10; ++i) {
    recording.Take({1, kGimbal}, MavlinkAttitude{1000 + i, 2.0F});
  }
  recording.Take(1, MavlinkAttitude{1000, 1.0F});
  recording.Take(1, OutputAt(1000000, 1500, 1500));
  const SourceLog log = std::move(recording).Finish({});
  EXPECT_EQ(log.heading.size(), 1u);
  EXPECT_THAT(log.summary, testing::HasSubstr("; system 1; heading"));
}

TEST(MavlinkRecording, CountsAGroundStationAsNoVehicle) {
  MavlinkRecording recording;
  recording.Take(1, MavlinkAttitude{1000, 1.0F});
  recording.Take(255, MavlinkSystemTime{1700000000000000, 50000});
  EXPECT_THAT(std::move(recording).Finish({}).summary, testing::HasSubstr("; system 1; heading"));
}

TEST(MavlinkRecording, TakesNoPositionAtZeroZeroFromAFilterThatHasNone) {
  MavlinkRecording recording;
  recording.Take(1, MavlinkGlobalPositionInt{1000, 0.0, 0.0, 10.0});
  recording.Take(1, MavlinkGlobalPositionInt{1200, 63.4, 10.4, 11.0});
  const SourceLog log = std::move(recording).Finish({});
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_EQ(log.gnss[0].latitude_deg, 63.4);
  EXPECT_EQ(log.heading.size(), 2u);
}

TEST(MavlinkRecording, TakesTheFilterOnlyWhereTheReceiverAndTheAttitudeAreSilent) {
  MavlinkRecording recording;
  recording.Take(1, MavlinkGlobalPositionInt{1000, 63.0, 10.0, 10.0});
  recording.Take(1, MavlinkGpsRawInt{1100000, 63.4, 10.4, 3});
  recording.Take(1, MavlinkAttitude{1100, 1.0F});
  recording.Take(1, MavlinkGlobalPositionInt{1200, 63.0, 10.0, 10.0});
  const SourceLog log = std::move(recording).Finish({});
  ASSERT_EQ(log.gnss.size(), 1u);
  EXPECT_EQ(log.gnss[0].latitude_deg, 63.4);
  ASSERT_EQ(log.heading.size(), 1u);
  EXPECT_NEAR(log.heading[0].heading_deg, 57.2957795, 1e-5);
}

TEST(MavlinkRecording, NamesTheSettingThatRaisesALowRate) {
  MavlinkRecording recording;
  NameOutputs(recording, 1);
  for (std::uint32_t i = 0; i < 10; ++i) recording.Take(1, OutputAt(500000 * i, 1500, 1500));
  EXPECT_THAT(std::move(recording).Finish({}).summary,
              testing::HasSubstr("SERVO_OUTPUT_RAW comes at 2.0 Hz only: set SR0_RC_CHAN to 10"));
}

TEST(MavlinkRecording, SaysWhichChannelIsMissing) {
  MavlinkRecording recording;
  recording.Take(1, MavlinkGpsRawInt{2000000, 63.4, 10.4, 3});
  const auto lacks = std::move(recording).Finish({}).Lacks();
  ASSERT_EQ(lacks.size(), 2u);
  EXPECT_EQ(lacks[0].subject, "heading");
  EXPECT_EQ(lacks[1].subject, "thrusters");
}

}  // namespace
}  // namespace telltale
