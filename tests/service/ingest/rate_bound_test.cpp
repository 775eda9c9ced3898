#include "telltale/service/ingest/rate_bound.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numeric>

#include <gtest/gtest.h>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

using Change = RateBound::Change;

constexpr auto kTick = std::chrono::milliseconds(4);  // 250 in a second

double Sum(const ChannelShares& shares, const ChannelCounts& arriving) {
  return std::inner_product(shares.begin(), shares.end(), arriving.begin(), 0.0);
}

// Of 5 fixes, 50 headings and 10 commands, by hand: what is too much is taken from the headings
// down to 5 of them, then from the fixes down to 1, then from the commands down to 5; then from
// all.
TEST(SharesWithin, ThinHeadingsFirstThenPositionsThenCommands) {
  struct Case {
    double most, gnss, heading, thrusters;
  };
  for (const Case& c :
       {Case{65, 1, 1, 1}, Case{100, 1, 1, 1}, Case{40, 1, 0.5, 1}, Case{20, 1, 0.1, 1},
        Case{18, 0.6, 0.1, 1}, Case{16, 0.2, 0.1, 1}, Case{15, 0.2, 0.1, 0.9},
        Case{11, 0.2, 0.1, 0.5}, Case{5.5, 0.1, 0.05, 0.25}}) {
    const ChannelShares shares = SharesWithin(c.most, {5, 50, 10});
    EXPECT_NEAR(shares[0], c.gnss, 1e-12) << c.most;
    EXPECT_NEAR(shares[1], c.heading, 1e-12) << c.most;
    EXPECT_NEAR(shares[2], c.thrusters, 1e-12) << c.most;
  }
}

TEST(SharesWithin, TakeInAllThatIsAllowedAndSilenceNoChannel) {
  RandomEngine random(27);
  for (int i = 0; i < 1000; ++i) {
    const ChannelCounts arriving = {random() % 100, random() % 1000, random() % 200};
    const double most = 1.0 + static_cast<double>(random() % 1500);
    const double total = Sum({1.0, 1.0, 1.0}, arriving);
    const ChannelShares shares = SharesWithin(most, arriving);
    EXPECT_NEAR(Sum(shares, arriving), std::min(most, total), 1e-9);
    for (const double share : shares) {
      EXPECT_GT(share, 0.0);
      EXPECT_LE(share, 1.0);
    }
  }
}

TEST(Thinner, KeepsEveryFourthOfAQuarterAndAllOfAll) {
  Thinner thinner;
  for (int i = 1; i <= 100; ++i) EXPECT_EQ(thinner.Keep(0.25), i % 4 == 0) << i;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(thinner.Keep(1.0));
}

/// A boat of 250 headings and 50 commands a second.
class Overload : public testing::Test {
 protected:
  /// Sends for so many seconds; returns how many samples a second are kept.
  double Send(int duration_s) {
    std::uint64_t kept = 0;
    for (int tick = 0; tick < 250 * duration_s; ++tick) {
      now_ += kTick;
      kept += Keep(Channel::kHeading, heading_);
      if (tick % 5 == 0) kept += Keep(Channel::kThrusters, thrusters_);
    }
    return static_cast<double>(kept) / duration_s;
  }

  std::uint64_t Keep(Channel channel, Thinner& thinner) {
    const Change change = bound_.Count(channel, now_);
    begun_ += change == Change::kBeginsToThin;
    ended_ += change == Change::kEndsToThin;
    return thinner.Keep(bound_.ShareOf(channel));
  }

  RateBound bound_{100.0};
  RateBound::Clock::time_point now_{std::chrono::hours(1)};
  Thinner heading_, thrusters_;
  int begun_ = 0;
  int ended_ = 0;
};

TEST_F(Overload, IsThinnedToTheBoundOnceAsManyHaveComeAsASecondMayBring) {
  EXPECT_LE(Send(1), 100.0 + 100.0);  // all of the first third of a second
  EXPECT_NEAR(Send(20), 100.0, 1.0);
  EXPECT_DOUBLE_EQ(bound_.ShareOf(Channel::kThrusters), 1.0);
  EXPECT_NEAR(bound_.arriving_per_s(), 300.0, 6.0);
  EXPECT_EQ(begun_, 1);
  EXPECT_EQ(ended_, 0);
}

TEST_F(Overload, EndsOnceAllHasFittedForTenSeconds) {
  Send(5);
  const auto send_little = [this](int duration_s) {
    for (int i = 0; i < 50 * duration_s; ++i) {
      now_ += 5 * kTick;
      Keep(Channel::kHeading, heading_);
    }
  };
  send_little(9);
  EXPECT_EQ(ended_, 0);
  EXPECT_DOUBLE_EQ(bound_.ShareOf(Channel::kHeading), 1.0);
  send_little(5);
  EXPECT_EQ(ended_, 1);
  EXPECT_EQ(begun_, 1);
}

TEST_F(Overload, IsNoneAfterASilence) {
  now_ += std::chrono::hours(10);
  for (int i = 0; i < 99; ++i) EXPECT_EQ(Keep(Channel::kHeading, heading_), 1u);
  now_ += std::chrono::seconds(1);
  EXPECT_EQ(Keep(Channel::kHeading, heading_), 1u);
  EXPECT_EQ(begun_, 0);
}

}  // namespace
}  // namespace telltale
