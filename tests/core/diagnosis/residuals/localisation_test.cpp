#include "telltale/core/diagnosis/residuals/localisation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"

namespace telltale {
namespace {

using Push = std::function<NuDot(const Nu& nu, const PropellerCommand& delta)>;

/// StableBoat() with a push that it does not know of, for five minutes.
PreparedDataset Pushed(const Push& push, std::uint64_t seed) {
  constexpr double kDurationS = 300.0;
  constexpr double kStepS = 0.02;
  const BodyDynamics dynamics(testing::StableBoat());
  const auto commands = testing::VariedCommands(kDurationS, seed);
  std::vector<TimedState> track;
  VesselState state;
  std::size_t now = 0;
  for (double time_s = 0.0; time_s < kDurationS; time_s += kStepS) {
    while (now + 1 < commands.size() && commands[now + 1].time_s <= time_s) ++now;
    const PropellerCommand& delta = commands[now].delta;
    track.push_back({time_s, state, delta});
    NuDot applied = dynamics.Propelled(ThrustOf(Parameterization::kPropeller, delta));
    const NuDot pushed = push(state.nu, delta);
    applied = {applied.u + pushed.u, applied.v + pushed.v, applied.r + pushed.r};
    const Nu next = dynamics.Step(applied, state.nu, kStepS);
    state.eta = NextPose(state.eta, state.nu, next, kStepS);
    state.nu = next;
  }
  SensorOptions sensors;
  sensors.seed = seed;
  return *Prepare(Measure(track, testing::StableBoatVehicle(), sensors),
                  testing::StableBoatVehicle(), PrepareOptions::Robust());
}

/// The bins listed of surge with both propellers ahead, "" being all of them.
std::vector<std::string> BinsAhead(const Push& push) {
  const auto none = [](const Nu&, const PropellerCommand&) { return NuDot(); };
  std::vector<std::string> bins;
  for (const GapCell& cell :
       Localise(Pushed(push, 5), {Pushed(none, 6)}, {testing::StableBoat(), {}}, 1)) {
    if (cell.channel == Equation::kSurge && cell.region == PropellerRegion::kFF) {
      bins.push_back(cell.bin);
    }
  }
  return bins;
}

bool Ahead(const PropellerCommand& delta) {
  return delta.port > 0.0 && delta.starboard > 0.0;
}

// To name the speeds one by one would tell nothing more.
TEST(Where, ListsARegionOnceWhereItsSpeedsAreAlike) {
  const auto bins = BinsAhead([](const Nu&, const PropellerCommand& delta) {
    return NuDot{Ahead(delta) ? -0.1 : 0.0, 0.0, 0.0};
  });
  EXPECT_THAT(bins, ::testing::ElementsAre(""));
}

TEST(Where, NamesTheSpeedOfARegionThatHoldsItAll) {
  const auto bins = BinsAhead([](const Nu& nu, const PropellerCommand& delta) {
    const double speed = std::hypot(nu.u, nu.v);
    return NuDot{Ahead(delta) && speed > 0.5 && speed < 1.0 ? -0.2 : 0.0, 0.0, 0.0};
  });
  EXPECT_THAT(bins, ::testing::Contains("0.5 to 1.0 m/s"));
}

}  // namespace
}  // namespace telltale
