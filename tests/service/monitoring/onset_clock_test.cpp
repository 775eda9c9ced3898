#include "telltale/service/monitoring/onset_clock.hpp"

#include <optional>

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(EarliestOnset, StaysWhereAnotherTestFindsTheDriftLater) {
  EarliestOnset drift;
  drift.Note({std::nullopt, std::nullopt});
  EXPECT_FALSE(drift.onset());
  drift.Note({std::nullopt, OnsetTime{100.0, 1.0}});
  drift.Note({OnsetTime{160.0, 61.0}, OnsetTime{100.0, 1.0}});
  EXPECT_EQ(drift.onset()->unix_s, 100.0);
  drift.Note({OnsetTime{160.0, 61.0}, std::nullopt});
  EXPECT_EQ(drift.onset()->unix_s, 100.0);
  EXPECT_EQ(drift.onset()->vehicle_s, 1.0);
}

TEST(EarliestOnset, MovesBackWhereATestFindsAnEarlierOne) {
  EarliestOnset drift;
  drift.Note({std::nullopt, OnsetTime{100.0, 1.0}});
  drift.Note({OnsetTime{40.0, -59.0}, OnsetTime{100.0, 1.0}});
  EXPECT_EQ(drift.onset()->unix_s, 40.0);
}

TEST(EarliestOnset, IsThatOfTheNextDriftOnceOneHasEnded) {
  EarliestOnset drift;
  drift.Note({OnsetTime{40.0, 1.0}, std::nullopt});
  drift.Note({std::nullopt, std::nullopt});
  EXPECT_FALSE(drift.onset());
  drift.Note({OnsetTime{400.0, 361.0}, std::nullopt});
  EXPECT_EQ(drift.onset()->unix_s, 400.0);
}

}  // namespace
}  // namespace telltale
