#include "telltale/service/role.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

using namespace std::chrono_literals;

const Role::Clock::time_point kAssumed{100s};

TEST(Role, OfADaemonAloneIsToServeForEver) {
  const Role role(std::nullopt);
  EXPECT_TRUE(role.Serves(kAssumed));
  EXPECT_TRUE(role.Serves(kAssumed + 10000h));
}

TEST(Role, IsNotHeldBeforeItIsAssumed) {
  Role role(2s);
  EXPECT_FALSE(role.Serves(kAssumed));
  role.Renew(kAssumed);
  EXPECT_FALSE(role.Serves(kAssumed));
}

TEST(Role, LastsAsLongAsItIsRenewed) {
  Role role(2s);
  role.Assume(kAssumed);
  role.Renew(kAssumed + 1900ms);
  EXPECT_TRUE(role.Serves(kAssumed + 3800ms));
  EXPECT_FALSE(role.Serves(kAssumed + 3900ms));
}

// Another daemon may serve by then.
TEST(Role, CannotBeRenewedOnceItHasRunOut) {
  Role role(2s);
  role.Assume(kAssumed);
  role.Renew(kAssumed + 2s);
  EXPECT_FALSE(role.Serves(kAssumed + 2s));
}

TEST(Role, EndsWhenItIsGivenUp) {
  Role role(2s);
  role.Assume(kAssumed);
  role.Resign();
  role.Renew(kAssumed + 1s);
  EXPECT_FALSE(role.Serves(kAssumed + 1s));
}

}  // namespace
}  // namespace telltale
