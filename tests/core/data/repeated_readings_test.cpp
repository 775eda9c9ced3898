#include "telltale/core/data/repeated_readings.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "telltale/core/data/preparation.hpp"

namespace telltale {
namespace {

constexpr double kTurnDegPerS = 8.0;
constexpr double kSensorPeriodS = 0.2;

// A minute of a boat that runs straight for half of it and then turns, by a log of 9 Hz.
Recording LoggedAt9Hz(double (*heading_at)(double)) {
  Recording recording;
  for (int i = 0; i < 540; ++i) {
    const double t = i / 9.0;
    recording.heading.push_back({t, heading_at(t)});
    recording.gnss.push_back({t, 37.4 + 1e-5 * t, -6.0});
    recording.thrusters.push_back({t, 1600.0, 1650.0});
  }
  return recording;
}

double TrueHeading(double t) {
  return 40.0 + 0.01 * std::sin(3.0 * t) + (t > 30.0 ? kTurnDegPerS * (t - 30.0) : 0.0);
}

double HeadingOfASlowerCompass(double t) {
  return TrueHeading(kSensorPeriodS * std::floor(t / kSensorPeriodS));
}

double HeadingOfACoarseCompass(double t) {
  return std::round(TrueHeading(t));
}

TEST(RepeatedReadings, LeavesOneReadingOfEachOfASlowerSensor) {
  const auto own = WithoutRepeatedReadings(LoggedAt9Hz(HeadingOfASlowerCompass));
  ASSERT_TRUE(own);
  EXPECT_EQ(own->heading.size(), 300U) << "60 s at 5 Hz";
  EXPECT_EQ(own->rejected.Of(Channel::kHeading, RejectReason::kRepeated), 240U);
  EXPECT_EQ(own->gnss.size(), 540U);
  for (std::size_t i = 1; i < own->heading.size(); ++i) {
    EXPECT_NE(own->heading[i].heading_deg, own->heading[i - 1].heading_deg);
  }
}

// Half of its readings repeat the one before: those of the straight course.
TEST(RepeatedReadings, AreNoneOfACoarseCompass) {
  EXPECT_FALSE(WithoutRepeatedReadings(LoggedAt9Hz(HeadingOfACoarseCompass)));
}

TEST(RepeatedReadings, AreNoneOfASensorThatKeepsUp) {
  EXPECT_FALSE(WithoutRepeatedReadings(LoggedAt9Hz(TrueHeading)));
}

TEST(RepeatedReadings, AreNoneOfARecordingWithoutReadings) {
  EXPECT_FALSE(WithoutRepeatedReadings({}));
}

TEST(RepeatedReadings, AreCountedByThePreparation) {
  const auto dataset =
      Prepare(LoggedAt9Hz(HeadingOfASlowerCompass), Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset) << dataset.error().reason;
  EXPECT_EQ(dataset->rejected.Of(RejectReason::kRepeated), 240U);
  ASSERT_EQ(dataset->signals.size(), 1U);
  EXPECT_LE(dataset->signals.front().psi_rad.values.size(), 300U);
}

}  // namespace
}  // namespace telltale
