#include "telltale/service/web/request_rates.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

using std::chrono::seconds;

class RequestRatesTest : public ::testing::Test {
 protected:
  std::optional<seconds> Ask(const std::string& client, int at_s) {
    return rates_.Wait(client, RequestRates::Clock::time_point(seconds(1000 + at_s)));
  }

  RequestRates rates_{2};
};

TEST_F(RequestRatesTest, CountsEachClientByItself) {
  EXPECT_FALSE(Ask("a", 0));
  EXPECT_FALSE(Ask("a", 1));
  EXPECT_EQ(Ask("a", 2), seconds(58));
  EXPECT_FALSE(Ask("b", 2));
}

TEST_F(RequestRatesTest, BeginsAnewWithEachMinute) {
  for (int i = 0; i < 3; ++i) Ask("a", 0);
  EXPECT_TRUE(Ask("a", 59));
  EXPECT_FALSE(Ask("a", 60));
}

TEST_F(RequestRatesTest, CountsClientsBeyondThoseItKnowsTogether) {
  for (int i = 0; i < 1024; ++i) EXPECT_FALSE(Ask(std::to_string(i), 0));
  EXPECT_FALSE(Ask("x", 0));
  EXPECT_FALSE(Ask("y", 0));
  EXPECT_TRUE(Ask("z", 0));
  EXPECT_FALSE(Ask("0", 0)) << "one that is known keeps its count";
}

}  // namespace
}  // namespace telltale
