#include "telltale/core/vessel/reverse_loss.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(ReverseLoss, LeavesHalfAtItsSpeedAndNothingFarAboveIt) {
  const ReverseLoss loss{0.5};
  EXPECT_DOUBLE_EQ(loss.Share(2.0), 0.5);
  EXPECT_NEAR(loss.Share(1.0), 256.0 / 257.0, 1e-15);
  EXPECT_LT(loss.Share(4.0), 0.004);
}

TEST(ReverseLoss, TakesNothingAsternOrWhereThereIsNone) {
  EXPECT_EQ(ReverseLoss{0.5}.Share(-3.0), 1.0);
  EXPECT_EQ(ReverseLoss{0.5}.ByU(-3.0), 0.0);
  EXPECT_EQ(ReverseLoss{}.Share(100.0), 1.0);
  EXPECT_EQ(ReverseLoss{}.ByPerSpeed(100.0), 0.0);
}

TEST(ReverseLoss, HasTheSlopesOfCentralDifferences) {
  // Half way between truncation (step squared) and rounding (1e-16 over the step).
  constexpr double kStep = 1e-5;
  for (const double u : {0.4, 1.5, 2.0, 2.6}) {
    const ReverseLoss loss{0.5};
    EXPECT_NEAR(loss.ByU(u), (loss.Share(u + kStep) - loss.Share(u - kStep)) / (2.0 * kStep), 1e-8);
    const double above = ReverseLoss{0.5 + kStep}.Share(u);
    const double below = ReverseLoss{0.5 - kStep}.Share(u);
    EXPECT_NEAR(loss.ByPerSpeed(u), (above - below) / (2.0 * kStep), 1e-6);
  }
}

}  // namespace
}  // namespace telltale
