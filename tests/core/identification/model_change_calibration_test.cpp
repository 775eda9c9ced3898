// How often an unchanged boat is called different, with the estimator as it comes. The data come
// from the simulator of bench/coverage.
#include <algorithm>

#include <gtest/gtest.h>

#include "coverage/independent_simulator.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/identification/model_comparison.hpp"

namespace telltale {
namespace {

constexpr std::size_t kPairs = 24;

Identification TenMinutesOf(const coverage::Boat& boat, std::uint64_t seed) {
  coverage::Mission mission;
  mission.segments = 15;
  IdentifyOptions options;
  options.seed = seed;
  return Identify(coverage::Simulate(boat, coverage::SimulatedEnvironment{}, mission, seed),
                  coverage::VehicleOf(), options)
      .value();
}

std::vector<double> PValues(const coverage::Boat& earlier, const coverage::Boat& later) {
  std::vector<double> p(kPairs);
  ForEachIndex(kPairs, 2, [&](std::size_t i) {
    const auto change =
        ChangeBetween(TenMinutesOf(earlier, 9000 + 2 * i), TenMinutesOf(later, 9001 + 2 * i));
    p[i] = change.value().p_value;
  });
  std::sort(p.begin(), p.end());
  return p;
}

auto Below(const std::vector<double>& p, double level) {
  return std::count_if(p.begin(), p.end(), [&](double value) { return value < level; });
}

// At an honest 1 % three or more of 24 have a chance of 0.2 %. The bounds are on the wide side
// (docs/validation/coverage.md), so p-values are too: most lie above a half.
TEST(ChangeCalibration, CallsAnUnchangedBoatDifferentAsRarelyAsItSays) {
  const auto p = PValues(coverage::ReferenceBoat(), coverage::ReferenceBoat());
  EXPECT_LE(Below(p, kSignificantChange), 2);
}

TEST(ChangeCalibration, SeesATenthLessThrust) {
  coverage::Boat worn = coverage::ReferenceBoat();
  for (std::size_t i = 5; i < 9; ++i) worn.surge[i] *= 0.9;
  for (std::size_t i = 9; i < 13; ++i) worn.yaw[i] *= 0.9;
  const auto p = PValues(coverage::ReferenceBoat(), worn);
  EXPECT_GE(Below(p, kSignificantChange), 20);
}

}  // namespace
}  // namespace telltale
