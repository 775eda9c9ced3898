#include "uncertainty/interval.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "contract.hpp"

namespace telltale {
namespace {

/// Two-sided critical values of Student's t, NIST/SEMATECH e-Handbook of Statistical Methods,
/// section 1.3.6.7.2, columns 0.975 and 0.95.
TEST(StudentInterval, AgreesWithThePublishedTable) {
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 1.0, 0.95).upper, 12.706, 5e-4);
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 10.0, 0.95).upper, 2.228, 5e-4);
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 30.0, 0.95).upper, 2.042, 5e-4);
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 10.0, 0.90).upper, 1.812, 5e-4);
}

TEST(StudentInterval, IsCentredAndScalesWithTheStandardError) {
  const Interval interval = StudentInterval(3.0, 0.5, 10.0, 0.95);
  EXPECT_NEAR(interval.lower, 3.0 - 0.5 * 2.228, 3e-4);
  EXPECT_NEAR(interval.upper, 3.0 + 0.5 * 2.228, 3e-4);
  EXPECT_DOUBLE_EQ(interval.level, 0.95);
}

/// Hyndman and Fan type 7 by hand: of 0..40 the position of share q is 40 q.
TEST(PercentileInterval, InterpolatesBetweenOrderStatistics) {
  std::vector<double> replicates;
  for (int i = 40; i >= 0; --i) replicates.push_back(i * i);
  const Interval interval = PercentileInterval(replicates, 0.95);
  EXPECT_NEAR(interval.lower, 1.0, 1e-9);          // position 1 -> 1
  EXPECT_NEAR(interval.upper, 39.0 * 39.0, 1e-9);  // position 39
  const Interval wide = PercentileInterval(replicates, 0.9625);
  EXPECT_NEAR(wide.lower, 0.75, 1e-9);  // position 0.75 between 0 and 1
}

TEST(PercentileInterval, NeedsTwoReplicates) {
  EXPECT_THROW(PercentileInterval(std::vector<double>{1.0}, 0.95), ContractViolation);
}

TEST(Unbounded, RulesNothingOut) {
  EXPECT_TRUE(std::isinf(Unbounded(0.95).lower));
  EXPECT_TRUE(std::isinf(Unbounded(0.95).upper));
}

// Quantiles of the normal law, from any table: 1.959964 at 0.975, 1.644854 at 0.95.
TEST(NormalInterval, HoldsTabulatedQuantiles) {
  const Interval wide = NormalInterval(3.0, 2.0, 0.95);
  EXPECT_EQ(wide.level, 0.95);
  EXPECT_NEAR(wide.lower, 3.0 - 2.0 * 1.959964, 1e-6);
  EXPECT_NEAR(wide.upper, 3.0 + 2.0 * 1.959964, 1e-6);
  EXPECT_NEAR(NormalInterval(0.0, 1.0, 0.9).upper, 1.644854, 1e-6);
  EXPECT_EQ(NormalInterval(3.0, 0.0, 0.95).upper, 3.0);
  EXPECT_TRUE(std::isinf(NormalInterval(3.0, std::numeric_limits<double>::infinity(), 0.95).lower));
}

}  // namespace
}  // namespace telltale
