#include "telltale/core/effects/gust_pattern.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace telltale {
namespace {

constexpr double kPeriodS = 8.0;

InstantState At(double time_s) {
  InstantState instant;
  instant.time_s = time_s;
  instant.nu = {1.0, 0.2, 0.1};
  instant.psi_rad = 0.4;
  return instant;
}

TEST(GustPattern, IsTheEffectWithTheValueOfTheInstant) {
  const Effect& wind = *FindEffect("wind");
  const GustPattern gust(wind, {1, 2.0, 2.0 * std::numbers::pi / kPeriodS, 0.0});
  const std::vector<double> mean = {3.0, -4.0, 1.0, 0.5, 0.1, 1.0};
  for (const auto& [time_s, east] :
       {std::pair{0.0, -2.0}, std::pair{0.25 * kPeriodS, -4.0}, std::pair{0.5 * kPeriodS, -6.0}}) {
    const InstantState instant = At(time_s);
    const NuDot gusting = gust.AddedAcceleration(mean, instant);
    const NuDot steady =
        wind.AddedAcceleration(std::vector{3.0, east, 1.0, 0.5, 0.1, 1.0}, instant);
    EXPECT_NEAR(gusting.u, steady.u, 1e-12) << time_s;
    EXPECT_NEAR(gusting.v, steady.v, 1e-12) << time_s;
    EXPECT_NEAR(gusting.r, steady.r, 1e-12) << time_s;
  }
}

TEST(GustPattern, VariesTheShareOfAThrusterToo) {
  const Effect& loss = *FindEffect("intermittent_thrust_loss");
  const GustPattern gust(loss, {0, 0.2, std::numbers::pi, 0.0});
  const std::vector<double> mean = {0.3};
  EXPECT_DOUBLE_EQ(gust.ThrustShare(mean, Side::kPort, At(0.0)), 0.5);
  EXPECT_DOUBLE_EQ(gust.ThrustShare(mean, Side::kPort, At(1.0)), 0.9);
  EXPECT_DOUBLE_EQ(gust.ThrustShare(mean, Side::kStarboard, At(0.0)), 1.0);
}

}  // namespace
}  // namespace telltale
