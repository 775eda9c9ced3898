#include "telltale/core/drift/drift_test.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace telltale {
namespace {

enum Change : Eigen::Index { kPort = 0, kStarboard = 1, kDrag = 2, kCompass = 3 };

constexpr double kPrecision = 200.0;  // of a window: in five minutes, a standard error of 0.009
constexpr std::size_t kBlock = kDrift.block_windows;
const std::string kEveryChange = "port thruster, starboard thruster, drag, compass";

/// Windows in whose errors a change shows, and nothing else.
std::vector<DriftEvidence> Windows(std::size_t count, Change change, double size,
                                   double precision = kPrecision) {
  DriftEvidence window = DriftEvidence::None();
  window.free_runs.information(change, change) = precision;
  window.free_runs.projection[change] = precision * size;
  window.free_runs.squares = precision * size * size;
  window.free_runs.terms = 9.0;
  return std::vector(count, window);
}

std::vector<DriftEvidence> Reference(Change change, double size = 0.0) {
  return Windows(20 * kBlock, change, size);
}

/// Minutes until it fires; 0: not within half an hour.
int MinutesUntilAlarm(DriftTest& test, const std::vector<DriftEvidence>& block) {
  for (int minute = 1; minute <= 30; ++minute) {
    test.Add(block);
    if (test.Fires()) return minute;
  }
  return 0;
}

/// The shortest span, and a minute that confirms it.
constexpr int kSoonest = 6;

TEST(DriftTest, FindsAndNamesAChangeAfterTheShortestSpan) {
  DriftTest test(Reference(kPort));
  EXPECT_EQ(MinutesUntilAlarm(test, Windows(kBlock, kPort, 0.15)), kSoonest);
  EXPECT_EQ(test.Alarm().front().Describe(), "port thruster 15 % weaker");
  DriftTest other(Reference(kStarboard));
  EXPECT_EQ(MinutesUntilAlarm(other, Windows(kBlock, kStarboard, -0.15)), kSoonest);
  EXPECT_EQ(other.Alarm().front().Describe(), "starboard thruster 15 % weaker");
}

TEST(DriftTest, IsSilentWithinToleranceHoweverSureTheChangeIs) {
  DriftTest test(Reference(kPort));
  EXPECT_EQ(MinutesUntilAlarm(test, Windows(kBlock, kPort, 0.05, 1e6)), 0);
  EXPECT_FALSE(test.Rises());
}

TEST(DriftTest, TakesOffWhatTheModelErrsItself) {
  const double predicted = 0.3 * kDrift.changes[kDrag].reference_slope;
  const double beyond = 1.2 * kDrift.changes[kDrag].tolerance;
  DriftTest test(Reference(kDrag, 0.3));
  EXPECT_EQ(MinutesUntilAlarm(test, Windows(kBlock, kDrag, predicted)), 0);
  EXPECT_GT(MinutesUntilAlarm(test, Windows(kBlock, kDrag, predicted + beyond)), 0);
}

TEST(DriftTest, SaysNothingOfWhatTheWindowsDoNotTell) {
  DriftTest test(Reference(kPort));
  EXPECT_EQ(MinutesUntilAlarm(test, Windows(kBlock, kPort, 0.9, 0.1)), 0);
  DriftTest without_reference(std::vector<DriftEvidence>(20 * kBlock, DriftEvidence::None()));
  EXPECT_EQ(MinutesUntilAlarm(without_reference, Windows(kBlock, kPort, 0.9)), 0);
}

TEST(DriftTest, AStrongerThrusterOrLessDragIsNoFault) {
  DriftTest thrust(Reference(kPort));
  EXPECT_EQ(MinutesUntilAlarm(thrust, Windows(kBlock, kPort, -0.3)), 0);
  DriftTest drag(Reference(kDrag));
  EXPECT_EQ(MinutesUntilAlarm(drag, Windows(kBlock, kDrag, -0.5)), 0);
}

TEST(DriftTest, ACompassMayTurnToEitherSide) {
  for (const double bias_rad : {0.07, -0.07}) {
    DriftTest test(Windows(20 * kBlock, kCompass, 0.0, 2000.0));
    EXPECT_GT(MinutesUntilAlarm(test, Windows(kBlock, kCompass, bias_rad, 2000.0)), 0);
  }
}

TEST(DriftTest, SaysNothingWhereErrorsFollowNoPattern) {
  DriftTest test(Reference(kPort));
  std::vector<DriftEvidence> block = Windows(kBlock, kPort, 0.15);
  for (DriftEvidence& window : block) window.free_runs.squares += 9.0 * 5.0;
  EXPECT_EQ(MinutesUntilAlarm(test, block), 0);
}

TEST(DriftTest, NoSingleMinuteDecides) {
  DriftTest test(Reference(kPort));
  const std::vector<DriftEvidence> nominal = Windows(kBlock, kPort, 0.0);
  const std::vector<DriftEvidence> strange = Windows(kBlock, kPort, 0.9);
  const auto minutes_fire = [&](const std::vector<DriftEvidence>& minute) {
    test.Add(minute);
    return test.Fires();
  };
  for (std::size_t minute = 0; minute < kDrift.spans.back(); ++minute) minutes_fire(nominal);
  EXPECT_FALSE(minutes_fire(strange));
  EXPECT_TRUE(test.Rises()) << "it is beyond the tolerance of thrust, yet by one minute alone";
  EXPECT_FALSE(minutes_fire(nominal));
  EXPECT_FALSE(minutes_fire(strange)) << "for the first time beyond doubt";
  EXPECT_TRUE(minutes_fire(strange));
}

TEST(DriftTest, SaysWhichChangesAreNotSeparable) {
  // One slope for both: what the errors show may be either change, or any mixture of the two.
  std::vector<DriftEvidence> windows = Windows(20 * kBlock, kPort, 0.0);
  const auto show = [](DriftEvidence& window, double size) {
    for (const Change row : {kPort, kDrag}) {
      const double slope = row == kDrag ? 0.3 : 1.0;
      for (const Change column : {kPort, kDrag}) {
        window.free_runs.information(row, column) =
            kPrecision * slope * (column == kDrag ? 0.3 : 1.0);
      }
      window.free_runs.projection[row] = kPrecision * slope * size;
    }
  };
  for (DriftEvidence& window : windows) show(window, 0.0);
  DriftTest test(windows);
  std::vector<DriftEvidence> block = Windows(kBlock, kPort, 0.2);
  for (DriftEvidence& window : block) show(window, 0.2);
  ASSERT_GT(MinutesUntilAlarm(test, block), 0);
  ASSERT_EQ(test.Alarm().size(), 2);
  EXPECT_NE(test.Alarm()[0].change, test.Alarm()[1].change);
  DriftTest other(Reference(kPort));
  ASSERT_GT(MinutesUntilAlarm(other, Windows(kBlock, kPort, 0.2)), 0);
  EXPECT_EQ(other.Alarm().size(), 1);
}

TEST(DriftTest, EndsOnceTheBoatIsAsItWas) {
  DriftTest test(Reference(kPort));
  ASSERT_GT(MinutesUntilAlarm(test, Windows(kBlock, kPort, 0.15)), 0);
  const std::vector<DriftEvidence> silence(kBlock, DriftEvidence::None());
  for (int minute = 0; minute < 30; ++minute) test.Add(silence);
  EXPECT_TRUE(test.Fires()) << "no evidence is none that it has ended";
  for (std::size_t minute = 0; minute < kDrift.spans.back(); ++minute) {
    test.Add(Windows(kBlock, kPort, 0.0));
  }
  EXPECT_FALSE(test.Fires());
}

TEST(DriftTest, SaysWhatItCannotTestAndWhy) {
  DriftTest test(Reference(kPort));
  EXPECT_EQ(test.Untested(), kEveryChange + ": too little has come yet");
  for (std::size_t minute = 0; minute < kDrift.spans.front(); ++minute) {
    test.Add(Windows(kBlock, kPort, 0.0));
  }
  EXPECT_EQ(test.Untested(),
            "starboard thruster, drag, compass: commands and heading vary too little");
  std::vector<DriftEvidence> strange = Windows(kBlock, kPort, 0.0);
  for (DriftEvidence& window : strange) window.free_runs.squares += 9.0 * 10.0;
  for (std::size_t minute = 0; minute < kDrift.spans.back(); ++minute) test.Add(strange);
  EXPECT_EQ(test.Untested(), kEveryChange + ": the errors are large and follow no known pattern");
}

TEST(DriftTest, TestsEveryChangeThatTheWindowsTell) {
  std::vector<DriftEvidence> windows = Windows(20 * kBlock, kPort, 0.0);
  for (DriftEvidence& window : windows) {
    for (const Change change : {kStarboard, kDrag, kCompass}) {
      window.free_runs.information(change, change) = 10.0 * kPrecision;
    }
  }
  DriftTest test(windows);
  for (std::size_t minute = 0; minute < kDrift.spans.front(); ++minute) {
    test.Add(std::span(windows).first(kBlock));
  }
  EXPECT_EQ(test.Untested(), "");
}

}  // namespace
}  // namespace telltale
