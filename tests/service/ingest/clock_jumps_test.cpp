#include "telltale/service/ingest/clock_jumps.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

using std::chrono::seconds;

constexpr double kLimitS = 60.0;
constexpr ClockJumps::Clock::time_point kStart{seconds(1000)};

TEST(ClockJumps, CountsStepsAheadAndBack) {
  ClockJumps jumps(kLimitS);
  jumps.Note(0.1, kStart);
  jumps.Note(1000.0, kStart + seconds(1));
  EXPECT_EQ(jumps.count(), 1u);
  jumps.Note(0.1, kStart + seconds(2));
  jumps.Note(-1000.0, kStart + seconds(3));
  EXPECT_EQ(jumps.count(), 2u);
}

TEST(ClockJumps, TellsASilenceFromAJump) {
  ClockJumps jumps(kLimitS);
  jumps.Note(0.1, kStart);
  jumps.Note(3600.0, kStart + seconds(3590));
  EXPECT_EQ(jumps.count(), 0u);
  jumps.Note(3600.0, kStart + seconds(3590 + 3500));
  EXPECT_EQ(jumps.count(), 1u);
}

TEST(ClockJumps, SaysNothingOfTheFirstSample) {
  ClockJumps jumps(kLimitS);
  jumps.Note(1000.0, kStart);
  EXPECT_EQ(jumps.count(), 0u);
}

}  // namespace
}  // namespace telltale
