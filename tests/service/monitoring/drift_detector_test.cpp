#include "telltale/service/monitoring/drift_detector.hpp"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace telltale {
namespace {

/// Evaluations, five seconds apart, until the test fires; none: not within an hour.
std::optional<int> EvaluationsUntilDrift(double relative_error) {
  DriftDetector test;
  for (int i = 1; i <= 720; ++i) {
    test.Add(relative_error);
    if (test.Fires()) return i;
  }
  return std::nullopt;
}

TEST(DriftDetector, FiresTheSoonerTheWorseAndNeverWithinBounds) {
  EXPECT_EQ(EvaluationsUntilDrift(3.0), 16);  // 20 / 1.25
  EXPECT_EQ(EvaluationsUntilDrift(2.0), 80);  // 20 / 0.25
  EXPECT_EQ(EvaluationsUntilDrift(1.75), std::nullopt);
  EXPECT_EQ(EvaluationsUntilDrift(std::nan("")), std::nullopt);
  EXPECT_EQ(EvaluationsUntilDrift(HUGE_VAL), 1);
}

TEST(DriftDetector, OneBadMinuteIsNoDrift) {
  DriftDetector test;
  for (int i = 0; i < 1000; ++i) {
    test.Add(i % 12 == 0 ? 4.0 : 1.0);
    EXPECT_FALSE(test.Fires()) << i;
  }
}

TEST(DriftDetector, EndsOnceTheErrorHasBeenSmallAgain) {
  DriftDetector test;
  for (int i = 0; i < 100; ++i) test.Add(5.0);
  EXPECT_TRUE(test.Fires());
  int until = 0;
  for (; test.Fires() && until < 100; ++until) test.Add(1.0);
  EXPECT_EQ(until, 54);  // 40 / 0.75
}

}  // namespace
}  // namespace telltale
