#include "telltale/core/uncertainty/profile_interval.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(ProfileInterval, OfAParabolaIsTheNormalInterval) {
  const auto deviance = [](double x) { return std::pow((x - 3.0) / 0.5, 2); };
  const Interval found = ProfileInterval(deviance, {3.0, 0.5, -100.0, 100.0}, 1.96 * 1.96, 0.95);
  EXPECT_EQ(found.level, 0.95);
  EXPECT_NEAR(found.lower, 3.0 - 0.98, 2e-3);
  EXPECT_NEAR(found.upper, 3.0 + 0.98, 2e-3);
  EXPECT_NEAR(Asymmetry(found, 3.0), 1.0, 5e-3);
}

// The mean of n exponential waits: deviance 2n (m/x - 1 - log(m/x)), whose ends for n = 10, m = 1
// and the 95 % point of chi-square, 3.8415, solve m/x - 1 - log(m/x) = 0.19207: 0.561 and 2.018.
TEST(ProfileInterval, IsAsAsymmetricAsTheLikelihood) {
  const auto deviance = [](double x) { return 20.0 * (1.0 / x - 1.0 + std::log(x)); };
  const Interval found = ProfileInterval(deviance, {1.0, 0.3, 1e-3, 100.0}, 3.841459, 0.95);
  EXPECT_NEAR(deviance(found.lower), 3.841459, 0.02);
  EXPECT_NEAR(deviance(found.upper), 3.841459, 0.02);
  EXPECT_GT(Asymmetry(found, 1.0), 1.5);
}

TEST(ProfileInterval, EndsWhereNothingIsAllowedBeyond) {
  const auto flat_below = [](double x) { return x > 1.0 ? (x - 1.0) * 10.0 : 0.0; };
  const Interval found = ProfileInterval(flat_below, {1.0, 0.1, 0.2, 50.0}, 4.0, 0.9);
  EXPECT_EQ(found.lower, 0.2);
  EXPECT_NEAR(found.upper, 1.4, 1e-3);
}

}  // namespace
}  // namespace telltale
