#include "telltale/core/identification/physical_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/identification/channel_delays.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/core/identification/posterior_draws.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

constexpr double kCommandDelayS = 0.05;
constexpr double kFixDelayS = 0.1;

FossenVector Truth() {
  FossenVector p;
  p << 1.5, 0.03, 0.18, 0.15, 0.45, 1.2, 0.05, -0.05, 0.25, 1.5, 0.4, -0.1, 0.05, 0.2, 0.3, 0.0,
      0.0, 0.1, 0.5, 1.6, 0.4, 1.2, 0.5, 0.04, 0.06, 0.08, 0.25, kCommandDelayS, kFixDelayS;
  return p;
}

Vehicle SurveyVehicle() {
  Vehicle vehicle;
  vehicle.vehicle_id = "boat";
  vehicle.propeller_separation_m = 0.62;
  return vehicle;
}

// Ten minutes of the boat, its clocks apart: commands stamped early, fixes stamped late.
Recording TenMinutes() {
  const VesselModel model = VesselModelOf(Truth(), SurveyVehicle().propeller_separation_m);
  const auto track = Simulate(model, {}, SampleMission(1), 600.0, 0.02);
  SensorOptions sensors;
  sensors.thruster_period_s = 0.02;  // as often as the commands can change
  Recording recording = Measure(track, SurveyVehicle(), sensors);
  for (ThrusterSample& sample : recording.thrusters) sample.time_s -= kCommandDelayS;
  for (GnssFix& fix : recording.gnss) fix.time_s += kFixDelayS;
  return recording;
}

class PhysicalModelOfASimulatedBoat : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    IdentifyOptions options;
    options.regression.structure = Structure::kFossen;
    options.threads = 2;
    auto identified = Identify(TenMinutes(), SurveyVehicle(), options);
    ASSERT_TRUE(identified) << identified.error().reason;
    model_ = new Identification(*identified);
  }
  static void TearDownTestSuite() {
    delete model_;
    model_ = nullptr;
  }
  void SetUp() override { ASSERT_NE(model_, nullptr); }

  static const Coefficient& Parameter(FossenParameter at) {
    return model_->physical->parameters[static_cast<std::size_t>(at)];
  }

  static inline Identification* model_ = nullptr;
};

TEST_F(PhysicalModelOfASimulatedBoat, FindsEveryParameterWithinFourStandardErrors) {
  const FossenVector truth = Truth();
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    const Coefficient& parameter = model_->physical->parameters[i];
    EXPECT_NEAR(parameter.estimate, truth[static_cast<Eigen::Index>(i)],
                4.0 * parameter.standard_error)
        << parameter.symbol;
  }
}

TEST_F(PhysicalModelOfASimulatedBoat, BoundsDragAndThrustWithinATenth) {
  for (const FossenParameter at : {kXuu, kNrr, kForwardQuadratic, kReverseQuadratic}) {
    EXPECT_LT(Parameter(at).standard_error, 0.1 * Parameter(at).estimate) << Parameter(at).symbol;
  }
}

TEST_F(PhysicalModelOfASimulatedBoat, FindsTheDelaysToHundredths) {
  EXPECT_NEAR(Parameter(kCommandDelay).estimate, kCommandDelayS, 0.01);
  EXPECT_NEAR(Parameter(kFixDelay).estimate, kFixDelayS, 0.01);
}

TEST_F(PhysicalModelOfASimulatedBoat, HasTheDelaysThatAreEstimatedAlone) {
  const auto delays = EstimateChannelDelays(TenMinutes(), SurveyVehicle(), 2);
  ASSERT_TRUE(delays) << delays.error().reason;
  for (const auto& [alone, at] :
       {std::pair(delays->commands, kCommandDelay), std::pair(delays->fixes, kFixDelay)}) {
    EXPECT_EQ(alone.estimate, Parameter(at).estimate);
    EXPECT_EQ(alone.interval.lower, Parameter(at).interval.lower);
    EXPECT_EQ(alone.interval.upper, Parameter(at).interval.upper);
  }
  EXPECT_EQ(delays->start_s, model_->window.start_s);
  EXPECT_EQ(delays->end_s, model_->window.end_s);
}

TEST(PhysicalModel, NeedsTheDistanceBetweenThePropellers) {
  const auto delays = EstimateChannelDelays(TenMinutes(), Vehicle(), 1);
  ASSERT_FALSE(delays);
  EXPECT_EQ(delays.error().subject, "propeller_separation_m");
}

TEST_F(PhysicalModelOfASimulatedBoat, ImpliesTheCoefficientsOfItsParameters) {
  const VesselModel implied =
      VesselModelOf(model_->physical->Estimates(), model_->physical->propeller_separation_m);
  const auto model = ModelOf(*model_);
  ASSERT_TRUE(model);
  for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(model->theta[j], implied.theta[j]);
  EXPECT_EQ(model->thruster_time_constant_s, implied.thruster_time_constant_s);
}

// Drag that opposes the motion and a positive time constant hold in every draw.
TEST_F(PhysicalModelOfASimulatedBoat, HasDrawsThatArePhysical) {
  constexpr std::size_t kCount = 200;
  const auto draws = DrawFromPosterior(*model_, kCount, 7);
  ASSERT_TRUE(draws);
  ASSERT_EQ(draws->theta.cols(), static_cast<Eigen::Index>(kCount));
  ASSERT_EQ(draws->theta.rows(), static_cast<Eigen::Index>(model_->coefficients.size()));
  for (std::size_t i = 0; i < model_->coefficients.size(); ++i) {
    const Coefficient& coefficient = model_->coefficients[i];
    const Eigen::VectorXd of_draws = draws->theta.row(static_cast<Eigen::Index>(i));
    const double mean = of_draws.mean();
    // The mean of draws errs by a standard error over the root of their number; five of those. An
    // estimate at the end of its range is 1.34 standard errors off the mean of the half-normal
    // law there: its mean is 0.80 sigma off the end, its deviation 0.60 sigma.
    EXPECT_NEAR(mean, coefficient.estimate,
                1e-12 + (5.0 / std::sqrt(kCount) + 1.34) * coefficient.standard_error)
        << coefficient.symbol;
    if (coefficient.regressor == "u|u|" || coefficient.regressor == "v|v|") {
      EXPECT_LE(coefficient.equation == Equation::kYaw ? 0.0 : of_draws.maxCoeff(), 0.0);
    }
  }
  for (const double time_constant_s : draws->time_constant_s) EXPECT_GT(time_constant_s, 0.0);
}

TEST_F(PhysicalModelOfASimulatedBoat, IsComparedByItsParametersWithoutTheClocks) {
  Identification fouled = *model_;
  Coefficient& drag = fouled.physical->parameters[static_cast<std::size_t>(kXuu)];
  drag.estimate += 20.0 * drag.standard_error;
  const auto change = ChangeBetween(*model_, fouled);
  ASSERT_TRUE(change) << change.error().reason;
  EXPECT_EQ(change->verdict, ChangeVerdict::kChanged);
  EXPECT_EQ(change->coefficients.front().symbol, "Xuu");
  Identification late = *model_;
  late.physical->parameters[static_cast<std::size_t>(kFixDelay)].estimate += 0.5;
  const auto same = ChangeBetween(*model_, late);
  ASSERT_TRUE(same) << same.error().reason;
  EXPECT_EQ(same->verdict, ChangeVerdict::kNoSignificantChange);
}

// A slender hull with little damping that turns to one side by itself, as the model ship CyberShip
// II does, in gusts.
FossenVector KeepsNoCourse() {
  FossenVector p;
  p << 1.35, 0.04, 0.11, 0.03, 0.10, 0.03, 0.20, 0.0, 0.08, 1.1, 0.1, -0.1, 0.01, 0.05, 0.1, 0.1,
      -0.05, 0.02, 0.02, 0.08, 0.02, 0.06, 0.3, 0.0, 0.04, 0.04, 0.1, 0.0, 0.0;
  return p;
}

// `sigma` of the gusts in m/s^2 and rad/s^2.
Recording InGusts(const FossenVector& parameters, double duration_s, double sigma,
                  std::uint64_t seed) {
  constexpr double kStepS = 0.02;
  constexpr double kTimeConstantS = 4.0;
  const VesselModel model = VesselModelOf(parameters, SurveyVehicle().propeller_separation_m);
  std::array gusts{GaussMarkov(sigma, kTimeConstantS, kStepS, WhiteSource(seed, 0)),
                   GaussMarkov(sigma, kTimeConstantS, kStepS, WhiteSource(seed, 1)),
                   GaussMarkov(sigma, kTimeConstantS, kStepS, WhiteSource(seed, 2))};
  std::vector<TimedState> track;
  VesselState state;
  for (const TimedState& planned : Simulate(model, {}, SampleMission(seed), duration_s, kStepS)) {
    track.push_back({planned.time_s, state, planned.delta});
    state = Advance(model, state, planned.delta, kStepS);
    state.nu.u += kStepS * gusts[0].Next();
    state.nu.v += kStepS * gusts[1].Next();
    state.nu.r += kStepS * gusts[2].Next();
  }
  return Measure(track, SurveyVehicle(), {});
}

// The boat that the commands alone drive turns elsewhere than this one did, and its slopes tell
// nothing of it.
TEST(PhysicalModel, IsFoundOfABoatThatKeepsNoCourse) {
  IdentifyOptions options;
  options.regression.structure = Structure::kFossen;
  options.threads = 2;
  const auto identified =
      Identify(InGusts(KeepsNoCourse(), 600.0, 0.01, 1), SurveyVehicle(), options);
  ASSERT_TRUE(identified) << identified.error().reason;
  for (const Refusal& warning : identified->refusals) {
    EXPECT_NE(warning.subject, "model") << warning.reason;
  }
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    const Coefficient& parameter = identified->physical->parameters[i];
    EXPECT_NEAR(parameter.estimate, KeepsNoCourse()[static_cast<Eigen::Index>(i)],
                4.0 * parameter.standard_error)
        << parameter.symbol;
  }
  // Instruments that follow the filter need the noise of the boat, not that of filtered readings,
  // which is five times as large. Steps of less than 5 % end its search.
  const double fix_noise_m = SensorOptions{}.position_noise_m;
  EXPECT_NEAR(identified->physical->noise.fix_sigma_m, fix_noise_m, 0.1 * fix_noise_m);
}

bool IsConverged(const Identification& model) {
  return std::ranges::none_of(model.refusals,
                              [](const Refusal& warning) { return warning.subject == "model"; });
}

// Gusts as strong as the thrust: the slopes' equations, which follow them, seldom find rest, and
// those of the instruments are solved all the same in two of five such recordings of 50 s.
TEST(PhysicalModel, ConvergesWhereTheEquationsOfItsInstrumentsAreSolved) {
  FossenVector truth = Truth();
  truth[At(kCommandDelay)] = truth[At(kFixDelay)] = 0.0;
  IdentifyOptions options;
  options.regression.structure = Structure::kFossen;
  options.threads = 2;
  int converged = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    const auto identified = Identify(InGusts(truth, 50.0, 0.4, seed), SurveyVehicle(), options);
    ASSERT_TRUE(identified) << identified.error().reason;
    if (!IsConverged(*identified)) continue;
    ++converged;
    for (std::size_t i = 0; i < kFossenParameters; ++i) {
      const Coefficient& parameter = identified->physical->parameters[i];
      // Five blocks of time tell a standard error by four degrees of freedom: one in a thousand of
      // Student's draws is further off than 8.6.
      EXPECT_NEAR(parameter.estimate, truth[static_cast<Eigen::Index>(i)],
                  8.6 * parameter.standard_error)
          << parameter.symbol << ", seed " << seed;
    }
  }
  EXPECT_GE(converged, 4);
}

TEST(PhysicalModel, IsRefusedWhereCommandsNeverChange) {
  Recording still;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.1 * i;
    still.heading.push_back({t, 90.0 + 0.1 * (i % 3)});
    still.thrusters.push_back({t, 1600.0, 1600.0});
    if (i % 2 == 0) still.gnss.push_back({t, 45.0, 10.0 + 1e-7 * i});
  }
  IdentifyOptions options;
  options.regression.structure = Structure::kFossen;
  const auto refused = Identify(still, SurveyVehicle(), options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().subject, "commands");
}

}  // namespace
}  // namespace telltale
