#include "service/boat_and_client.hpp"

#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/loopback_domain.hpp"

namespace telltale {
namespace {

// A daemon that is killed before it saves anything reads back what the one before had saved. The
// fixes that died with that one were sent before its kill, seconds ago.
TEST(BoatAndClient, CountsNoFixForTwoKills) {
  const LoopbackDomain domain;
  BoatAndClient boat(domain.id(), SimulatedRecording());
  boat.Step();
  boat.ForgetWhatWasSent();
  const auto next_life = CampaignClock::now();
  boat.Step();
  const auto killed = CampaignClock::now();
  const double lived_s = std::chrono::duration<double>(killed - next_life).count();
  constexpr double kReadBackToS = 0.0;
  const double missing_s = boat.SentBefore(kReadBackToS, killed);
  EXPECT_GT(missing_s, 0.0);
  EXPECT_LE(missing_s, lived_s);
}

}  // namespace
}  // namespace telltale
