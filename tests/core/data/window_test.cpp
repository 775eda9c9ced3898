#include "telltale/core/data/window.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "support/special_values.hpp"
#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

GnssFix FixAt(double t) {
  return {t, 37.0 + std::sin(0.01 * t), -6.0};
}
HeadingSample HeadingAt(double t) {
  return {t, std::fmod(10.0 * t, 360.0)};
}
ThrusterSample ThrustersAt(double t) {
  return {t, 1600.0, 1600.0};
}

template <class Sample>
std::vector<double> Times(const std::vector<Sample>& samples) {
  std::vector<double> times;
  for (const Sample& sample : samples) times.push_back(sample.time_s);
  return times;
}

TEST(Window, KeepsValidSamplesInOrder) {
  Window window{{}};
  EXPECT_TRUE(window.Empty());
  EXPECT_EQ(window.Add(FixAt(1.0)), std::nullopt);
  EXPECT_EQ(window.Add(HeadingAt(0.5)), std::nullopt);
  EXPECT_EQ(window.Add(ThrustersAt(2.0)), std::nullopt);
  EXPECT_EQ(window.Size(Channel::kGnss), 1u);
  EXPECT_EQ(window.Size(Channel::kHeading), 1u);
  EXPECT_EQ(window.Size(Channel::kThrusters), 1u);
  EXPECT_EQ(window.StartTime(), 0.5);
  EXPECT_EQ(window.EndTime(), 2.0);
  EXPECT_EQ(window.Rejected().Total(), 0u);
}

TEST(Window, RejectsNonFiniteValues) {
  Window window{{}};
  EXPECT_EQ(window.Add(GnssFix{kNaN, 0, 0}), RejectReason::kNotFinite);
  EXPECT_EQ(window.Add(GnssFix{0, kInfinity, 0}), RejectReason::kNotFinite);
  EXPECT_EQ(window.Add(HeadingSample{0, -kInfinity}), RejectReason::kNotFinite);
  EXPECT_EQ(window.Add(ThrusterSample{0, 1500, kNaN}), RejectReason::kNotFinite);
  EXPECT_TRUE(window.Empty());
  EXPECT_EQ(window.Rejected().Of(RejectReason::kNotFinite), 4u);
  EXPECT_EQ(window.Rejected().Of(Channel::kGnss, RejectReason::kNotFinite), 2u);
}

TEST(Window, RejectsValuesOutOfRangeAndKeepsTheLimits) {
  Window window{{}};
  EXPECT_EQ(window.Add(GnssFix{0, 90.001, 0}), RejectReason::kOutOfRange);
  EXPECT_EQ(window.Add(GnssFix{0, 0, -180.001}), RejectReason::kOutOfRange);
  EXPECT_EQ(window.Add(GnssFix{0, 90, -180}), std::nullopt);
  EXPECT_EQ(window.Add(HeadingSample{0, 720.1}), RejectReason::kOutOfRange);
  EXPECT_EQ(window.Add(HeadingSample{0, -360.0}), std::nullopt);
  EXPECT_EQ(window.Add(ThrusterSample{0, 499, 1500}), RejectReason::kOutOfRange);
  EXPECT_EQ(window.Add(ThrusterSample{0, 1500, 2501}), RejectReason::kOutOfRange);
  EXPECT_EQ(window.Add(ThrusterSample{0, 500, 2500}), std::nullopt);
}

TEST(Window, CountsLateDuplicates) {
  Window window{{}};
  for (const double t : {0.0, 1.0, 2.0}) EXPECT_EQ(window.Add(FixAt(t)), std::nullopt);
  EXPECT_EQ(window.Add(FixAt(2.0)), RejectReason::kDuplicate);
  EXPECT_EQ(window.Add(FixAt(0.0)), RejectReason::kDuplicate);
  EXPECT_EQ(window.Add(HeadingAt(2.0)), std::nullopt) << "another channel may share the time";
}

TEST(Window, PutsLateSamplesInPlaceWithinTheTolerance) {
  Window window{{.reorder_tolerance_s = 0.5}};
  for (const double t : {0.0, 1.0, 0.6, 0.5}) EXPECT_EQ(window.Add(FixAt(t)), std::nullopt);
  EXPECT_EQ(window.Add(FixAt(0.4)), RejectReason::kOutOfOrder);
  EXPECT_EQ(Times(window.Snapshot().gnss), (std::vector{0.0, 0.5, 0.6, 1.0}));
}

TEST(Window, ALaggingChannelIsNotOutOfOrder) {
  Window window{{.reorder_tolerance_s = 0.0}};
  EXPECT_EQ(window.Add(HeadingAt(10.0)), std::nullopt);
  EXPECT_EQ(window.Add(FixAt(5.0)), std::nullopt);
}

TEST(Window, AnyOrderWithinTheToleranceGivesTheSameRecording) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> delay(0.0, 0.49);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<std::pair<double, double>> arrivals;
    for (int i = 0; i < 300; ++i) arrivals.emplace_back(0.1 * i + delay(engine), 0.1 * i);
    std::sort(arrivals.begin(), arrivals.end());
    Window window{{.reorder_tolerance_s = 0.5}};
    for (const auto& [arrival, t] : arrivals) {
      ASSERT_EQ(window.Add(FixAt(t)), std::nullopt);
      ASSERT_EQ(window.Add(HeadingAt(t)), std::nullopt);
    }
    const Recording recording = window.Snapshot();
    ASSERT_EQ(recording.gnss.size(), 300u);
    for (int i = 0; i < 300; ++i) {
      ASSERT_EQ(recording.gnss[i].time_s, 0.1 * i);
      ASSERT_EQ(recording.heading[i].heading_deg, HeadingAt(0.1 * i).heading_deg);
    }
  }
}

TEST(Window, DurationIsBoundedFromTheNewestOfAnyChannel) {
  Window window{{.duration_s = 10.0}};
  for (int i = 0; i <= 200; ++i) window.Add(FixAt(0.1 * i));
  EXPECT_GE(window.StartTime(), 10.0);
  EXPECT_EQ(window.Size(Channel::kGnss), 101u);
  window.Add(HeadingAt(25.0));
  EXPECT_GE(window.Snapshot().gnss.front().time_s, 15.0);
}

TEST(Window, MemoryIsBoundedAndTheOldestGoFirst) {
  const WindowLimits limits{.duration_s = 86400.0, .memory_bytes = 64 * 1024};
  Window window{limits};
  for (int i = 0; i < 20000; ++i) {
    ASSERT_EQ(window.Add(FixAt(0.1 * i)), std::nullopt);
    ASSERT_EQ(window.Add(HeadingAt(0.1 * i)), std::nullopt);
    ASSERT_LE(window.Size(Channel::kGnss) * sizeof(GnssFix) +
                  window.Size(Channel::kHeading) * sizeof(HeadingSample),
              limits.memory_bytes);
  }
  const Recording recording = window.Snapshot();
  EXPECT_NEAR(recording.gnss.front().time_s, recording.heading.front().time_s, 0.11);
  EXPECT_EQ(recording.gnss.back().time_s, 0.1 * 19999);
  EXPECT_GT(recording.gnss.size(), 1500u) << "the bound is used, not only kept";
}

TEST(Window, OneOutlyingStampRemovesNothing) {
  Window window{{}};
  for (int i = 0; i < 100; ++i) window.Add(FixAt(0.2 * i));
  EXPECT_EQ(window.Add(FixAt(1e9)), RejectReason::kClockJump);
  EXPECT_EQ(window.Add(FixAt(-1e9)), RejectReason::kClockJump);
  EXPECT_EQ(window.Add(FixAt(20.0)), std::nullopt);
  EXPECT_EQ(window.Size(Channel::kGnss), 101u);
}

TEST(Window, InconsistentOutlyingStampsAreNeverAccepted) {
  Window window{{}};
  window.Add(FixAt(1000.0));
  for (int i = 1; i < 100; ++i) {
    ASSERT_EQ(window.Add(FixAt(1000.0 + 1e4 * i * (i % 2 ? 1 : -1))), RejectReason::kClockJump);
  }
}

TEST(Window, ARepeatedStampConfirmsNoClock) {
  Window window{{}};
  window.Add(FixAt(1000.0));
  for (int i = 0; i < 100; ++i) ASSERT_EQ(window.Add(FixAt(0.0)), RejectReason::kClockJump);
  EXPECT_EQ(window.Add(FixAt(1000.2)), std::nullopt);
  EXPECT_EQ(window.Size(Channel::kGnss), 2u);
}

TEST(Window, SamplesOnTheOldClockInterruptTheNewOne) {
  Window window{{}};
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(window.Add(FixAt(1000.0 + 0.2 * i)), std::nullopt);
    ASSERT_EQ(window.Add(HeadingAt(0.2 * i)), RejectReason::kClockJump);
  }
}

TEST(Window, ARebootedBoatIsAcceptedOnItsNewClock) {
  Window window{{.clock_jump_confirmations = 5}};
  for (int i = 0; i < 100; ++i) {
    window.Add(FixAt(5000.0 + 0.2 * i));
    window.Add(HeadingAt(5000.0 + 0.2 * i));
  }
  for (int i = 0; i < 4; ++i) EXPECT_EQ(window.Add(FixAt(0.2 * i)), RejectReason::kClockJump);
  EXPECT_EQ(window.Size(Channel::kGnss), 100u);
  EXPECT_EQ(window.Add(FixAt(0.8)), std::nullopt);
  EXPECT_EQ(window.Size(Channel::kGnss), 1u);
  EXPECT_EQ(window.Size(Channel::kHeading), 0u) << "the clock is shared";
  EXPECT_EQ(window.EndTime(), 0.8);
  EXPECT_EQ(window.Add(HeadingAt(0.8)), std::nullopt);
}

/// 300 s of a boat on its own clock, then a burst of forged stamps, then the boat again.
std::size_t HeldAfterForgedStamps(const std::vector<double>& forged) {
  Window window{{.duration_s = 300.0}};
  for (int i = 0; i < 1500; ++i) window.Add(FixAt(1000.0 + 0.2 * i));
  for (const double time_s : forged) window.Add(FixAt(time_s));
  for (int i = 1500; i < 1520; ++i) window.Add(FixAt(1000.0 + 0.2 * i));
  return window.Size(Channel::kGnss);
}

TEST(Window, ForgedStampsAheadEmptyNothing) {
  EXPECT_GT(HeldAfterForgedStamps({5000.0, 5000.1, 5000.2, 5000.3, 5000.4, 5000.5}), 1490u);
}

TEST(Window, ForgedStampsBehindEmptyNothing) {
  std::vector<double> forged;
  for (int i = 0; i < 18; ++i) forged.push_back(1.0 + 0.1 * i);
  EXPECT_GT(HeldAfterForgedStamps(forged), 1490u);
}

TEST(Window, ForgedStampsAtTwoInstantsEmptyNothing) {
  std::vector<double> forged;
  for (int i = 0; i < 6; ++i) forged.push_back(5000.0 + 0.1 * i);
  for (int i = 0; i < 6; ++i) forged.push_back(9000.0 + 0.1 * i);
  EXPECT_GT(HeldAfterForgedStamps(forged), 1490u);
}

TEST(Window, ANewClockThatGoesOnIsKept) {
  Window window{{.duration_s = 300.0}};
  for (int i = 0; i < 1500; ++i) window.Add(FixAt(1000.0 + 0.2 * i));
  for (int i = 0; i < 600; ++i) window.Add(FixAt(0.2 * i));
  for (int i = 1500; i < 1510; ++i) window.Add(FixAt(1000.0 + 0.2 * i));
  EXPECT_EQ(window.EndTime(), 1000.0 + 0.2 * 1509) << "a jump ahead, by then";
  EXPECT_EQ(window.StartTime(), 1300.0 + 0.2 * 4);
}

TEST(Window, ALongRadioSilenceKeepsEarlierSamples) {
  Window window{{}};
  for (int i = 0; i < 100; ++i) window.Add(FixAt(0.2 * i));
  for (int i = 0; i < 100; ++i) window.Add(FixAt(300.0 + 0.2 * i));
  EXPECT_EQ(window.Rejected().Of(RejectReason::kClockJump), 4u);
  EXPECT_EQ(window.Size(Channel::kGnss), 196u);
}

TEST(Window, AReadingRepeatedWhileCommandsChangedIsStuck) {
  Window window{{.stuck_after_s = 5.0}};
  std::size_t stuck = 0;
  for (int i = 0; i < 300; ++i) {
    const double t = 0.1 * i;
    window.Add(ThrusterSample{t, i < 100 ? 1500.0 : 1700.0, 1500.0});
    window.Add(FixAt(t));
    if (window.Add(HeadingSample{t, 123.4})) ++stuck;
  }
  EXPECT_EQ(window.Rejected().Of(Channel::kHeading, RejectReason::kStuckSensor), stuck);
  // Commanded from 10 s on, so stuck from 15 s on: 150 of 300 samples, one more or less by
  // rounding.
  EXPECT_NEAR(static_cast<double>(stuck), 150.0, 2.0);
  EXPECT_EQ(window.Rejected().Total(), stuck);
  EXPECT_EQ(window.Add(HeadingSample{30.0, 124.0}), std::nullopt) << "a new reading is alive";
}

TEST(Window, ABoatAtRestMayRepeatItsPosition) {
  Window window{{.stuck_after_s = 5.0}};
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.2 * i;
    ASSERT_EQ(window.Add(ThrusterSample{t, 1500, 1500}), std::nullopt);
    ASSERT_EQ(window.Add(GnssFix{t, 37.0, -6.0}), std::nullopt);
  }
  // It sets off: the first fixes still read as before.
  for (int i = 1000; i < 1010; ++i) {
    ASSERT_EQ(window.Add(ThrusterSample{0.2 * i, 1900, 1900}), std::nullopt);
    ASSERT_EQ(window.Add(GnssFix{0.2 * i, 37.0, -6.0}), std::nullopt);
  }
}

TEST(Window, EverySampleIsKeptOrCounted) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    Window window{{.duration_s = 86400.0}};
    std::uint64_t added = 0;
    std::uint64_t kept = 0;
    for (int i = 0; i < 2000; ++i) {
      double t = 0.1 * i + 3.0 * (unit(engine) - 0.5);
      if (unit(engine) < 0.02) t = kNaN;
      if (unit(engine) < 0.02) t += 1e5;
      if (unit(engine) < 0.05) t = 0.1 * std::floor(i * unit(engine));
      const double heading = unit(engine) < 0.02 ? 999.0 : 360.0 * unit(engine);
      ++added;
      if (!window.Add(HeadingSample{t, heading})) ++kept;
    }
    ASSERT_EQ(kept + window.Rejected().Total(), added);
    ASSERT_EQ(window.Size(Channel::kHeading), kept) << "nothing expires within the duration";
    const Recording recording = window.Snapshot();
    ASSERT_TRUE(std::is_sorted(recording.heading.begin(), recording.heading.end(),
                               [](const auto& a, const auto& b) { return a.time_s < b.time_s; }));
    ASSERT_EQ(recording.rejected.Total(), window.Rejected().Total());
  }
}

TEST(Window, ASnapshotDoesNotChangeAfterwards) {
  Window window{{}};
  window.Add(FixAt(0.0));
  const Recording recording = window.Snapshot();
  window.Add(FixAt(1.0));
  EXPECT_EQ(recording.gnss.size(), 1u);
}

TEST(WindowLimits, NameFieldValueAndRange) {
  EXPECT_FALSE(WindowLimits{}.Validate());
  const auto refusal = WindowLimits{.duration_s = 5.0}.Validate();
  ASSERT_TRUE(refusal);
  EXPECT_THAT(refusal->reason, HasSubstr("duration_s = 5 must be within [10, 86400]"));
  EXPECT_TRUE(WindowLimits{.memory_bytes = 1000}.Validate());
  EXPECT_TRUE(WindowLimits{.reorder_tolerance_s = kNaN}.Validate());
  EXPECT_TRUE(WindowLimits{.clock_jump_s = 0.5}.Validate());
  EXPECT_TRUE(WindowLimits{.clock_jump_confirmations = 0}.Validate());
  EXPECT_TRUE(WindowLimits{.stuck_after_s = 0.0}.Validate());
  EXPECT_THROW(Window(WindowLimits{.duration_s = 5.0}), ContractViolation);
}

TEST(Window, GivesTheSamplesOfItsSnapshotAway) {
  Window window{{}};
  for (int i = 0; i < 1000; ++i) {
    window.Add(HeadingAt(0.1 * i));
    window.Add(ThrustersAt(0.1 * i));
  }
  window.Add(HeadingSample{5.0, 400000.0});
  const Recording copy = window.Snapshot();
  const Recording given = std::move(window).Release();
  EXPECT_EQ(Times(given.heading), Times(copy.heading));
  EXPECT_EQ(Times(given.thrusters), Times(copy.thrusters));
  EXPECT_EQ(given.rejected.Total(), copy.rejected.Total());
  EXPECT_EQ(given.rejected.Of(RejectReason::kOutOfRange), 1u);
}

}  // namespace
}  // namespace telltale
