#include "telltale/core/data/heading_unwrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace telltale {
namespace {

TEST(Unwrap, FollowsSeveralTurnsUnderAnyWrap) {
  for (const double turn_deg : {7.0, -33.0, 170.0}) {
    std::vector<HeadingSample> samples;
    for (int i = 0; i < 200; ++i) {
      const double truth = turn_deg * i;
      const double wrapped = truth - 360.0 * std::floor(truth / 360.0);
      samples.push_back({0.1 * i, i % 3 == 0 ? wrapped - 360.0 : wrapped});
    }
    const auto psi = Unwrap(samples);
    for (std::size_t i = 1; i < psi.size(); ++i) {
      ASSERT_NEAR(psi[i] - psi[i - 1], turn_deg * std::numbers::pi / 180.0, 1e-9);
    }
  }
}

TEST(Unwrap, OfNoSamplesIsEmpty) {
  EXPECT_TRUE(Unwrap({}).empty());
}

}  // namespace
}  // namespace telltale
