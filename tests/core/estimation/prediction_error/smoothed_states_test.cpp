#include "telltale/core/estimation/prediction_error/smoothed_states.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {
namespace {

constexpr double kDurationS = 60.0;
constexpr double kFixPeriodS = 0.2;
constexpr double kHeadingPeriodS = 0.1;

struct SteeredTrack {
  std::vector<double> times_s;
  std::vector<FilterState> truth;
  RawSignals signals;
  HeldCommands commands;
};

FilterSettings SteeredSettings() {
  FilterSettings settings;
  settings.parameters << 1.5, 0.03, 0.18, 0.15, 0.45, 1.2, 0.05, -0.05, 0.25, 1.5, 0.4, -0.1, 0.05,
      0.2, 0.3, 0.1, -0.1, 0.1, 0.5, 1.6, 0.4, 1.2, 0.5, 0.04, 0.06, 0.08, 0.25, 0.0, 0.0;
  settings.propeller_separation_m = 0.6;
  settings.noise.acceleration_sigma.setConstant(0.02);
  settings.noise.fix_drift_sigma_m = 0.01;
  settings.noise.stamp_sigma_s = 0.001;
  return settings;
}

HeldCommands Commands() {
  std::vector<ThrusterSample> samples;
  for (double t = 0.0; t <= kDurationS; t += 0.5) {
    samples.push_back({t, 1600.0 + 150.0 * std::sin(0.7 * t), 1600.0 + 150.0 * std::cos(0.4 * t)});
  }
  return HeldCommands(samples, Vehicle{});
}

// A boat of the form, its fixes and headings with the noise of SteeredSettings().
SteeredTrack Steered() {
  SteeredTrack track{{}, {}, {}, Commands()};
  for (double t = kHeadingPeriodS; t < kDurationS; t += kHeadingPeriodS) track.times_s.push_back(t);
  const FilterSettings settings = SteeredSettings();
  FilterState start = FilterState::Zero();
  start[kVelocityState] = 0.5;
  track.truth = PredictedStates(start, 0.0, track.commands, settings, track.times_s);
  std::mt19937 random(20261126);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < track.times_s.size(); ++i) {
    const double t = track.times_s[i];
    const FilterState& x = track.truth[i];
    track.signals.psi_rad.times_s.push_back(t);
    track.signals.psi_rad.values.push_back(HeadingOf(x) +
                                           settings.noise.heading_sigma_rad * normal(random));
    if (i % static_cast<std::size_t>(std::lround(kFixPeriodS / kHeadingPeriodS)) != 0) continue;
    const Eigen::Vector2d fix = FixOf(x, settings.antenna);
    track.signals.north_m.times_s.push_back(t);
    track.signals.north_m.values.push_back(fix[0] + settings.noise.fix_sigma_m * normal(random));
    track.signals.east_m.values.push_back(fix[1] + settings.noise.fix_sigma_m * normal(random));
  }
  track.signals.east_m.times_s = track.signals.north_m.times_s;
  return track;
}

// Of the velocities north and east over ground, from windows that reach `ahead_s`.
double ErrorWith(const SteeredTrack& track, double ahead_s) {
  std::vector<SmoothingWindow> windows;
  for (const double t : track.times_s) windows.push_back({t, t + ahead_s});
  const auto states = SmoothedStates(track.signals, track.commands, SteeredSettings(), windows);
  EXPECT_EQ(states.size(), windows.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Eigen::Vector3d error = (states[i] - track.truth[i]).segment<3>(kVelocityState);
    sum += error.head<2>().squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(states.size()));
}

// Five fixes and ten headings more tell of the same state: the variance of what they know alone is
// of the order of the filter's own.
TEST(SmoothedStates, ErrByLessThanTheFilterOfTheReadingsBefore) {
  const SteeredTrack track = Steered();
  const double filtered = ErrorWith(track, 0.0);
  EXPECT_LT(ErrorWith(track, 1.0), 0.9 * filtered);
}

TEST(SmoothedStates, ErrByNoMoreWithLongerWindows) {
  const SteeredTrack track = Steered();
  EXPECT_LT(ErrorWith(track, 5.0), ErrorWith(track, 1.0));
}

TEST(SmoothedStates, AreNoneWithoutHeadings) {
  SteeredTrack track = Steered();
  track.signals.psi_rad = {};
  EXPECT_TRUE(
      SmoothedStates(track.signals, track.commands, SteeredSettings(), {{1.0, 2.0}}).empty());
}

}  // namespace
}  // namespace telltale
