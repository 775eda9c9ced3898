#include "telltale/core/estimation/prediction_error/innovations.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

FossenVector BoatParameters() {
  FossenVector p;
  p << 1.5, 0.03, 0.18, 0.15, 0.45, 1.2, 0.05, -0.05, 0.25, 1.5, 0.4, -0.1, 0.05, 0.2, 0.3, 0.1,
      -0.1, 0.1, 0.5, 1.6, 0.4, 1.2, 0.5, 0.04, 0.06, 0.08, 0.25, 0.05, 0.1;
  return p;
}

struct Track {
  RawSignals signals;
  HeldCommands commands;
};

// A boat that weaves about a line at 1.5 m/s, and commands that have little to do with it: slopes
// have to be right whatever the readings are.
Track Weaving() {
  std::vector<ThrusterSample> commands;
  RawSignals signals;
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.1 * i;
    commands.push_back({t, 1500.0 + 350.0 * std::sin(0.7 * t), 1500.0 + 380.0 * std::cos(0.4 * t)});
    signals.psi_rad.times_s.push_back(t);
    signals.psi_rad.values.push_back(0.5 * std::sin(0.3 * t));
    if (i % 2 != 0) continue;
    signals.north_m.times_s.push_back(t);
    signals.north_m.values.push_back(1.5 * t);
    signals.east_m.values.push_back(2.0 * std::sin(0.3 * t));
  }
  signals.east_m.times_s = signals.north_m.times_s;
  return {signals, HeldCommands(commands, Vehicle{})};
}

FilterSettings Settings() {
  FilterSettings settings;
  settings.parameters = BoatParameters();
  settings.propeller_separation_m = 0.6;
  settings.antenna = {0.2, -0.1};
  settings.nominal_fix_delay_s = settings.parameters[At(kFixDelay)];
  return settings;
}

class InnovationSlope : public testing::TestWithParam<std::size_t> {};

TEST_P(InnovationSlope, IsThatOfCentralDifferencesAtFixedGains) {
  const Track track = Weaving();
  const FilterSettings settings = Settings();
  const auto own = SlopedInnovationsOf(track.signals, track.commands, settings, false);
  const auto at = static_cast<Eigen::Index>(GetParam());
  // Half way between truncation (step squared) and rounding (1e-16 over the step).
  constexpr double kStep = 1e-5;
  const auto moved = [&](double by) {
    FilterSettings shifted = settings;
    shifted.parameters[at] += by;
    return InnovationsWith(own.gains, track.signals, track.commands, shifted);
  };
  const auto above = moved(kStep);
  const auto below = moved(-kStep);
  double error = 0.0;
  double size = 0.0;
  for (std::size_t k = 0; k < own.slopes.size(); ++k) {
    const double difference = (above[k].value - below[k].value) / (2.0 * kStep);
    error += std::pow(difference - own.slopes[k].slope[at], 2);
    size += difference * difference;
  }
  EXPECT_GT(size, 0.0);
  // Slopes leave out terms of third order in the step, a share of up to (lambda h)^2 / 4 = 2.2 % at
  // the fastest rate, 3 /s, and the longest step, 100 ms.
  EXPECT_LT(std::sqrt(error / size), 2.2e-2);
}

INSTANTIATE_TEST_SUITE_P(OfEveryParameter, InnovationSlope,
                         testing::Range<std::size_t>(0, kFossenParameters), [](const auto& index) {
                           return std::string(FossenParameterNames()[index.param].symbol);
                         });

TEST(Innovations, AreTheSameWithTheirOwnGains) {
  const Track track = Weaving();
  const auto own = SlopedInnovationsOf(track.signals, track.commands, Settings(), false);
  const auto replayed = InnovationsWith(own.gains, track.signals, track.commands, Settings());
  ASSERT_EQ(own.innovations.size(), replayed.size());
  for (std::size_t k = 0; k < replayed.size(); ++k) {
    EXPECT_EQ(own.innovations[k].value, replayed[k].value);
  }
}

// A light boat with strong damping in yaw: 280 time constants a second, 14 in the longest step. The
// whole track is 60 m long.
TEST(Innovations, StayFiniteWhereDampingIsFasterThanAStep) {
  const Track track = Weaving();
  FilterSettings settings = Settings();
  settings.parameters[At(kNr)] = 5.0;
  settings.parameters[At(kM33)] = 0.018;
  settings.parameters[At(kM23)] = 0.0;
  for (const Innovation& innovation : InnovationsOf(track.signals, track.commands, settings)) {
    ASSERT_LT(std::abs(innovation.value), 60.0) << "at " << innovation.time_s << " s";
  }
}

// A boat at rest, whose readings stir by a hundredth of a millimetre or milliradian: its
// equations are linear, and axes of fixes do not turn with its way.
Track AtRest() {
  Track track = Weaving();
  std::vector<ThrusterSample> commands;
  for (int i = 0; i <= 40; ++i) commands.push_back({1.0 * i, 1500.0, 1500.0});
  track.commands = HeldCommands(commands, Vehicle{});
  const auto stir = [](std::vector<double>& values, double frequency) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = 1e-5 * std::sin(frequency * static_cast<double>(i));
    }
  };
  stir(track.signals.north_m.values, 0.7);
  stir(track.signals.east_m.values, 1.3);
  stir(track.signals.psi_rad.values, 0.4);
  return track;
}

TEST(InnovationsUnderNoises, AreThoseOfAFilterOfTheirOwnAtRest) {
  const Track track = AtRest();
  FilterSettings settings = Settings();
  std::vector<NoiseModel> noises(4, settings.noise);
  noises[0].acceleration_sigma *= 3.0;
  noises[1].acceleration_time_constant_s *= 0.3;
  noises[2].fix_drift_sigma_m *= 3.0;
  noises[2].fix_sigma_m *= 0.3;
  noises[3].heading_sigma_rad *= 0.3;
  const auto beside = InnovationsUnder(noises, track.signals, track.commands, settings);
  for (std::size_t i = 0; i < noises.size(); ++i) {
    settings.noise = noises[i];
    const auto own = InnovationsOf(track.signals, track.commands, settings);
    ASSERT_EQ(beside[i].size(), own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
      // Transitions leave out terms of fourth order in the step: (lambda h)^3 / 24 = 0.1 % at the
      // fastest rate, 3 /s, and the longest step, 100 ms, of readings that vary by 2e-5.
      EXPECT_NEAR(beside[i][k].value, own[k].value, 1.1e-3 * 2e-5);
      // What is not linear is of the size of the motion.
      EXPECT_NEAR(beside[i][k].variance, own[k].variance, 1e-4 * own[k].variance);
    }
  }
}

TEST(InnovationsUnderNoises, AreThoseOfTheFilterUnderItsOwn) {
  const Track track = Weaving();
  const FilterSettings settings = Settings();
  const auto own = InnovationsOf(track.signals, track.commands, settings);
  const auto beside = InnovationsUnder({settings.noise}, track.signals, track.commands, settings);
  ASSERT_EQ(beside[0].size(), own.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    EXPECT_EQ(beside[0][k].value, own[k].value);
    EXPECT_EQ(beside[0][k].variance, own[k].variance);
  }
}

TEST(Innovations, AreNoneWithoutHeadings) {
  Track track = Weaving();
  track.signals.psi_rad = {};
  EXPECT_TRUE(InnovationsOf(track.signals, track.commands, Settings()).empty());
}

// Headings that go on through a gap of the fixes would let the position drift before it is read.
TEST(Innovations, StartWhereBothChannelsAreRead) {
  const Track track = Weaving();
  Track early = Weaving();
  for (int i = 600; i > 10; --i) {
    const auto place = early.signals.psi_rad.times_s.begin() + (600 - i);
    early.signals.psi_rad.times_s.insert(place, -0.1 * i);
    early.signals.psi_rad.values.insert(early.signals.psi_rad.values.begin() + (600 - i), 2.0);
  }
  const auto expected = InnovationsOf(track.signals, track.commands, Settings());
  const auto innovations = InnovationsOf(early.signals, early.commands, Settings());
  ASSERT_EQ(innovations.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(innovations[k].value, expected[k].value);
  }
}

}  // namespace
}  // namespace telltale
