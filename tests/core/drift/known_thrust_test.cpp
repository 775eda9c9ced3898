#include "telltale/core/drift/known_thrust.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"

namespace telltale {
namespace {

// At full command ahead a side gives 2 + 3 = 5 m/s^2 in surge and twice that in yaw, with a
// standard error of sqrt(2) s each.
TEST(KnowsThrust, WhereItIsLargerThanItsStandardError) {
  const auto with_standard_errors = [](double s) {
    Identification made = IdentificationByHand();
    made.covariance *= s * s;
    return made;
  };
  const double limit = 5.0 / std::sqrt(2.0);
  EXPECT_TRUE(KnowsThrust(with_standard_errors(0.99 * limit)));
  EXPECT_FALSE(KnowsThrust(with_standard_errors(1.01 * limit)));
  EXPECT_FALSE(KnowsThrust(with_standard_errors(std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace telltale
