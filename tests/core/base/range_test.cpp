#include "telltale/core/base/range.hpp"

#include <gtest/gtest.h>

#include "support/special_values.hpp"

#include <limits>

namespace telltale {
namespace {

TEST(OutOfRange, AcceptsTheLimitsThemselves) {
  EXPECT_FALSE(OutOfRange("window", "x", 1.0, 1.0, 2.0));
  EXPECT_FALSE(OutOfRange("window", "x", 2.0, 1.0, 2.0));
}

TEST(OutOfRange, NamesSubjectFieldValueAndRange) {
  const auto refusal = OutOfRange("window", "x", 3.0, 1.0, 2.0);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->subject, "window");
  EXPECT_EQ(refusal->reason, "x = 3 must be within [1, 2]");
  EXPECT_EQ(OutOfRange("window", "x", 0.0, 1.0, kInfinity)->reason, "x = 0 must be at least 1");
  EXPECT_EQ(OutOfRange("window", "x", 3.0, -kInfinity, 2.0)->reason, "x = 3 must be at most 2");
}

TEST(OutOfRange, NaNIsOutsideEveryRange) {
  EXPECT_TRUE(
      OutOfRange("w", "x", std::numeric_limits<double>::quiet_NaN(), -kInfinity, kInfinity));
}

}  // namespace
}  // namespace telltale
