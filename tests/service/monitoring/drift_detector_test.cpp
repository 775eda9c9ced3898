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
  EXPECT_EQ(EvaluationsUntilDrift(6.0), 10);  // 20 / 2
  EXPECT_EQ(EvaluationsUntilDrift(4.5), 40);  // 20 / 0.5
  EXPECT_EQ(EvaluationsUntilDrift(4.0), std::nullopt);
  EXPECT_EQ(EvaluationsUntilDrift(std::nan("")), std::nullopt);
  EXPECT_EQ(EvaluationsUntilDrift(HUGE_VAL), 1);
}

TEST(DriftDetector, OneBadMinuteIsNoDrift) {
  DriftDetector test;
  for (int i = 0; i < 1000; ++i) {
    test.Add(i % 12 == 0 ? 8.0 : 1.0);
    EXPECT_FALSE(test.Fires()) << i;
  }
}

TEST(DriftDetector, EndsOnceTheErrorHasBeenSmallAgain) {
  DriftDetector test;
  for (int i = 0; i < 100; ++i) test.Add(9.0);
  EXPECT_TRUE(test.Fires());
  int until = 0;
  for (; test.Fires() && until < 100; ++until) test.Add(1.0);
  EXPECT_EQ(until, 14);  // 40 / 3
}

}  // namespace
}  // namespace telltale
