#include "telltale/service/standby/election.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace telltale {
namespace {

using namespace std::chrono_literals;
using Step = Election::Step;

constexpr Election::Clock::duration kLease = 2s;
const Election::Clock::time_point kStart{100s};
const auto kHeard = kStart + kLease;

DaemonStatus Standby(const std::string& id, std::uint32_t strength, std::uint32_t term = 0) {
  return {id, false, term, strength};
}

DaemonStatus Serving(const std::string& id, std::uint32_t strength, std::uint32_t term) {
  return {id, true, term, strength};
}

TEST(Election, OfOneDaemonWaitsUntilAnotherCouldHaveBeenHeard) {
  Election election(Standby("a", 1), kLease, kStart);
  EXPECT_EQ(election.Decide(kHeard - 1ms), Step::kWait);
  EXPECT_EQ(election.Decide(kHeard), Step::kTakeOver);
  election.TakeOver();
  EXPECT_TRUE(election.self().serves);
  EXPECT_EQ(election.self().term, 1u);
  EXPECT_EQ(election.Decide(kHeard), Step::kWait);
}

TEST(Election, GivesTheStrongerOfTwoThatStart) {
  Election weak(Standby("z", 1), kLease, kStart);
  Election strong(Standby("a", 2), kLease, kStart);
  weak.Hear(strong.self(), kStart);
  strong.Hear(weak.self(), kStart);
  EXPECT_EQ(weak.Decide(kHeard), Step::kWait);
  EXPECT_EQ(strong.Decide(kHeard), Step::kTakeOver);
}

TEST(Election, LeavesTheDaemonThatServesInItsPlace) {
  Election returned(Standby("a", 1000), kLease, kStart);
  Election serving(Standby("b", 1), kLease, kStart);
  serving.TakeOver();
  returned.Hear(serving.self(), kStart);
  serving.Hear(returned.self(), kStart);
  EXPECT_EQ(returned.Decide(kHeard + 1h), Step::kWait);
  EXPECT_EQ(serving.Decide(kHeard), Step::kWait);
}

// It need not listen: it knows who served.
TEST(Election, GivesTheStandbyAtOnceWhenTheDaemonThatServedIsGone) {
  Election standby(Standby("b", 1), kLease, kStart);
  standby.Hear(Serving("a", 2, 5), kStart);
  EXPECT_EQ(standby.Decide(kStart), Step::kWait);
  standby.Lose("a");
  EXPECT_EQ(standby.Decide(kStart), Step::kTakeOver);
  standby.TakeOver();
  EXPECT_EQ(standby.self().term, 6u);
}

// The stronger one has no window and does not know what was published.
TEST(Election, PrefersAStandbyThatHasFollowedToAStrongerOneThatHasNot) {
  Election standby(Standby("b", 1), kLease, kStart);
  standby.Hear(Serving("a", 2, 5), kStart);
  standby.Lose("a");
  Election fresh(Standby("c", 1000), kLease, kStart);
  fresh.Hear(standby.self(), kStart);
  standby.Hear(fresh.self(), kStart);
  EXPECT_EQ(fresh.Decide(kHeard), Step::kWait);
  EXPECT_EQ(standby.Decide(kHeard), Step::kTakeOver);
}

TEST(Election, OfTwoThatServeKeepsTheLaterTerm) {
  Election earlier(Standby("a", 1000), kLease, kStart);
  earlier.TakeOver();
  Election later(Standby("b", 1), kLease, kStart);
  later.Hear(earlier.self(), kStart);
  later.Lose("a");
  later.TakeOver();
  earlier.Hear(later.self(), kStart);
  later.Hear(earlier.self(), kStart);
  EXPECT_EQ(earlier.Decide(kStart), Step::kStepDown);
  EXPECT_EQ(later.Decide(kStart), Step::kWait);
}

TEST(Election, OfTwoThatServeForTheSameTermKeepsTheStronger) {
  Election weak(Standby("b", 1), kLease, kStart);
  Election strong(Standby("a", 2), kLease, kStart);
  weak.TakeOver();
  strong.TakeOver();
  weak.Hear(strong.self(), kStart);
  strong.Hear(weak.self(), kStart);
  EXPECT_EQ(weak.Decide(kStart), Step::kStepDown);
  EXPECT_EQ(strong.Decide(kStart), Step::kWait);
}

// After a loss of power, say: the weaker one has the later models.
TEST(Election, GivesTheOneWithTheLaterTermWhereAllStartAgain) {
  Election later(Standby("a", 1, 5), kLease, kStart);
  Election earlier(Standby("b", 2, 4), kLease, kStart);
  later.Hear(earlier.self(), kStart);
  earlier.Hear(later.self(), kStart);
  EXPECT_EQ(later.Decide(kHeard - 1ms), Step::kWait) << "another may serve and is not heard yet";
  EXPECT_EQ(earlier.Decide(kHeard), Step::kWait);
  EXPECT_EQ(later.Decide(kHeard), Step::kTakeOver);
  EXPECT_FALSE(later.HasFollowed());
  later.TakeOver();
  EXPECT_EQ(later.self().term, 6u);
}

// Whatever each knows of itself, exactly one of those that hear each other takes over.
TEST(Election, GivesOneOfMany) {
  std::vector<Election> all;
  for (const std::uint32_t term : {0u, 3u}) {
    for (const std::uint32_t strength : {1u, 2u}) {
      for (const char* name : {"x", "y"}) {
        const std::string id = name + std::to_string(term) + std::to_string(strength);
        all.emplace_back(Standby(id, strength, term), kLease, kStart);
      }
    }
  }
  for (Election& one : all) {
    for (const Election& other : all) {
      if (&one != &other) one.Hear(other.self(), kStart);
    }
  }
  EXPECT_EQ(std::ranges::count_if(
                all, [](const Election& one) { return one.Decide(kHeard) == Step::kTakeOver; }),
            1);
}

class CutOffElection : public ::testing::Test {
 protected:
  CutOffElection() { standby_.Hear(Serving("a", 2, 5), kStart); }

  Step DecideWithout(const std::string& id, Election::Clock::time_point now) {
    standby_.Lose(id);
    return standby_.Decide(now);
  }

  Election standby_{Standby("b", 1), kLease, kStart};
};

// Whoever takes over then has no fleet, and is behind when it hears the other again.
TEST_F(CutOffElection, WaitsWhereTheFleetFallsSilentWithTheDaemonThatServes) {
  standby_.HearFleet(kStart + 100ms);
  EXPECT_EQ(DecideWithout("a", kStart + kLease), Step::kWait);
  EXPECT_EQ(standby_.Decide(kStart + 2 * kLease), Step::kWait);
  standby_.HearFleet(kStart + 2 * kLease);
  EXPECT_EQ(standby_.Decide(kStart + 2 * kLease), Step::kTakeOver);
}

// The boats may have stopped by chance at that time.
TEST_F(CutOffElection, WaitsForThreeLeasesAtMost) {
  standby_.HearFleet(kStart + 100ms);
  EXPECT_EQ(DecideWithout("a", kStart + 3 * kLease - 1ms), Step::kWait);
  EXPECT_EQ(standby_.Decide(kStart + 3 * kLease), Step::kTakeOver);
}

TEST_F(CutOffElection, TakesOverWhereTheFleetIsHeardOn) {
  standby_.HearFleet(kStart + 1800ms);
  EXPECT_EQ(DecideWithout("a", kStart + kLease), Step::kTakeOver);
}

TEST_F(CutOffElection, TakesOverWhereTheFleetWasSilentBefore) {
  EXPECT_EQ(DecideWithout("a", kStart + kLease), Step::kTakeOver) << "never heard";
  standby_.Hear(Serving("a", 2, 5), kStart + 10s);
  standby_.HearFleet(kStart);
  EXPECT_EQ(DecideWithout("a", kStart + 10s + kLease), Step::kTakeOver);
}

TEST_F(CutOffElection, TakesOverAtOnceFromADaemonThatSaysThatItGoes) {
  standby_.HearFleet(kStart);
  EXPECT_EQ(DecideWithout("a", kStart + 100ms), Step::kTakeOver);
}

TEST(OwnershipStrength, OfALaterTermExceedsEveryEarlierOne) {
  for (const std::uint32_t term : {1u, 2u, 1000u, kHighestTerm - 1}) {
    EXPECT_GT(OwnershipStrengthOn(Serving("a", 1, term + 1)),
              OwnershipStrengthOn(Serving("b", kHighestStrength, term)));
  }
}

}  // namespace
}  // namespace telltale
