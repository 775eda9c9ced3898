// Two recordings of one boat in different winds. The data come from the simulator of
// bench/coverage.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "coverage/independent_simulator.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {
namespace {

constexpr std::array<std::array<double, 3>, 3> kHeadwind{
    {{-0.12, 0.0, 0.0}, {0.05, 0.0, 0.0}, {0.04, 0.0, 0.0}}};
constexpr std::array<std::array<double, 3>, 3> kStrongHeadwind{
    {{-0.24, 0.0, 0.0}, {0.10, 0.0, 0.0}, {0.08, 0.0, 0.0}}};
constexpr std::array<std::array<double, 3>, 3> kNorthWind{
    {{0.0, -0.15, 0.0}, {0.0, 0.0, 0.15}, {0.0, 0.0, 0.05}}};

template <class Sample>
void Append(const std::vector<Sample>& from, double shift_s, std::vector<Sample>& to) {
  for (Sample sample : from) {
    sample.time_s += shift_s;
    to.push_back(sample);
  }
}

/// A calm day at full commands, then a day in `wind` at 60 % of them: with one constant for both
/// the wind passes for a weakness of slow propellers.
Recording TwoDays(const std::array<std::array<double, 3>, 3>& wind, std::uint64_t seed) {
  coverage::Mission mission;
  mission.segments = 12;
  Recording both = coverage::Simulate(coverage::ReferenceBoat(), coverage::SimulatedEnvironment{},
                                      mission, seed);
  coverage::SimulatedEnvironment windy;
  windy.constant_disturbance = wind;
  mission.command_share = 0.6;
  const Recording second =
      coverage::Simulate(coverage::ReferenceBoat(), windy, mission, seed + 100'000);
  const double shift_s = both.thrusters.back().time_s + 500.0 - second.thrusters.front().time_s;
  both.starts_s = {both.thrusters.front().time_s, second.thrusters.front().time_s + shift_s};
  Append(second.gnss, shift_s, both.gnss);
  Append(second.heading, shift_s, both.heading);
  Append(second.thrusters, shift_s, both.thrusters);
  return both;
}

Identification IdentifiedWith(RecordingBiasModel recording_bias, const Recording& recording,
                              std::uint64_t seed = 1) {
  IdentifyOptions options;
  options.regression.recording_bias = recording_bias;
  options.seed = seed;
  return Identify(recording, coverage::VehicleOf(), options).value();
}

struct Score {
  double held = 0.0;   ///< share of the boat's own coefficients whose bounds hold the truth
  double error = 0.0;  ///< root mean square of errors in surge thrust, relative
};

Score ScoreOf(const Identification& identification) {
  const std::vector<double> truth = coverage::CoefficientsOf(coverage::ReferenceBoat());
  Score score;
  double counted = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Coefficient& c = identification.coefficients[i];
    if (c.regressor == "1") continue;
    counted += 1.0;
    score.held += truth[i] >= c.interval.lower && truth[i] <= c.interval.upper ? 1.0 : 0.0;
    const bool ahead = i == 5 || i == 6;
    if (ahead) score.error += std::pow((c.estimate - truth[i]) / truth[i], 2) / 2.0;
  }
  score.held /= counted;
  score.error = std::sqrt(score.error);
  return score;
}

TEST(RecordingBiasModel, HoldTheSteadyDisturbanceOfEachRecording) {
  const Identification found =
      IdentifiedWith(RecordingBiasModel::kPerRecording, TwoDays(kHeadwind, 1));
  ASSERT_EQ(found.recording_bias.size(), 2u);
  EXPECT_LT(found.recording_bias[0].end_s, found.recording_bias[1].start_s);
  const coverage::Boat boat = coverage::ReferenceBoat();
  const std::array<double, 3> calm = {boat.surge[4], boat.sway[8], boat.yaw[8]};
  for (std::size_t recording : {0u, 1u}) {
    const auto& coefficients = found.recording_bias[recording].coefficients;
    ASSERT_EQ(coefficients.size(), 3u);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_EQ(coefficients[j].equation, kEquations[j]);
      EXPECT_EQ(coefficients[j].regressor, "1");
      const double truth = calm[j] + (recording == 1 ? kHeadwind[j][0] : 0.0);
      // Four standard errors: one of these six beyond them has a chance of 1 in 2600.
      EXPECT_NEAR(coefficients[j].estimate, truth, 4.0 * coefficients[j].standard_error);
      EXPECT_LT(coefficients[j].standard_error, 0.02);
    }
  }
}

TEST(RecordingBiasModel, TheConstantOfTheModelIsTheirMean) {
  const Identification found =
      IdentifiedWith(RecordingBiasModel::kPerRecording, TwoDays(kHeadwind, 1));
  const double mean = (found.recording_bias[0].coefficients[0].estimate +
                       found.recording_bias[1].coefficients[0].estimate) /
                      2.0;
  ASSERT_EQ(found.coefficients[4].regressor, "1");
  EXPECT_NEAR(found.coefficients[4].estimate, mean, 1e-12);
  EXPECT_EQ(found.covariance.rows(), 35);
}

TEST(RecordingBiasModel, FindWhatStandsToTheNorth) {
  const Identification found =
      IdentifiedWith(RecordingBiasModel::kPerRecordingNorthEast, TwoDays(kNorthWind, 2));
  ASSERT_EQ(found.recording_bias.size(), 2u);
  const auto& windy = found.recording_bias[1].coefficients;
  ASSERT_EQ(windy.size(), 9u);
  const auto of = [&](Equation equation, const char* regressor) {
    return *std::find_if(windy.begin(), windy.end(), [&](const Coefficient& c) {
      return c.equation == equation && c.regressor == regressor;
    });
  };
  const Coefficient surge = of(Equation::kSurge, "cos(psi)");
  const Coefficient sway = of(Equation::kSway, "sin(psi)");
  EXPECT_NEAR(surge.estimate, -0.15, 4.0 * surge.standard_error);
  EXPECT_NEAR(sway.estimate, 0.15, 4.0 * sway.standard_error);
  EXPECT_LT(surge.standard_error, 0.03);
  EXPECT_LT(sway.standard_error, 0.03);
}

TEST(RecordingBiasModel, OfASingleRecordingAreTheSharedConstant) {
  coverage::Mission mission;
  mission.segments = 15;
  const Recording recording =
      coverage::Simulate(coverage::ReferenceBoat(), coverage::SimulatedEnvironment{}, mission, 3);
  const Identification shared = IdentifiedWith(RecordingBiasModel::kShared, recording);
  const Identification own = IdentifiedWith(RecordingBiasModel::kPerRecording, recording);
  EXPECT_TRUE(shared.recording_bias.empty());
  ASSERT_EQ(own.recording_bias.size(), 1u);
  for (std::size_t i = 0; i < shared.coefficients.size(); ++i) {
    EXPECT_NEAR(own.coefficients[i].estimate, shared.coefficients[i].estimate,
                1e-6 * shared.coefficients[i].standard_error);
  }
}

TEST(RecordingBiasModel, AreNotForOneStepLeastSquares) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.regression.recording_bias = RecordingBiasModel::kPerRecording;
  ASSERT_TRUE(options.Validate());
  EXPECT_EQ(options.Validate()->subject, "recording_bias");
}

// The bounds of the boat's own coefficients hold as they do in one recording; with one constant for
// both days thrust comes out wrong: twice as wrong in twice the wind, which test functions weighted
// by their innovations hardly count.
TEST(RecordingBiasModel, KeepTheBoundsOfTheBoatTrue) {
  constexpr std::size_t kRepeats = 20;
  std::vector<Score> own(kRepeats);
  std::vector<Score> shared(kRepeats);
  ForEachIndex(kRepeats, 2, [&](std::size_t i) {
    const Recording recording = TwoDays(kStrongHeadwind, 10 + i);
    own[i] = ScoreOf(IdentifiedWith(RecordingBiasModel::kPerRecording, recording, i));
    shared[i] = ScoreOf(IdentifiedWith(RecordingBiasModel::kShared, recording, i));
  });
  Score with;
  Score without;
  for (std::size_t i = 0; i < kRepeats; ++i) {
    with.held += own[i].held / kRepeats;
    with.error += own[i].error / kRepeats;
    without.held += shared[i].held / kRepeats;
    without.error += shared[i].error / kRepeats;
  }
  // Coefficients of one repeat err together: 20 repeats know the mean to about two points.
  EXPECT_GE(with.held, 0.90);
  EXPECT_LE(with.held, 0.995);
  EXPECT_LT(with.error, 0.6 * without.error);
  EXPECT_LT(without.held, with.held);
}

}  // namespace
}  // namespace telltale
