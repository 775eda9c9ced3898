#include "telltale/core/effects/augmented_boat.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "support/stable_boat.hpp"
#include "telltale/core/effects/augmented_simulation.hpp"
#include "telltale/core/effects/effect.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

constexpr double kStepS = 0.05;

/// Commands from time zero on, held for ever.
HeldCommands Held(const PropellerCommand& delta) {
  const Vehicle vehicle;
  const std::vector<ThrusterSample> samples = {
      {0.0, vehicle.port.PulseWidth(delta.port), vehicle.starboard.PulseWidth(delta.starboard)}};
  return {samples, vehicle};
}

/// A command that steps from rest at one second.
HeldCommands Stepped(const PropellerCommand& delta) {
  const Vehicle vehicle;
  const std::vector<ThrusterSample> samples = {
      {0.0, 1500.0, 1500.0},
      {1.0, vehicle.port.PulseWidth(delta.port), vehicle.starboard.PulseWidth(delta.starboard)}};
  return {samples, vehicle};
}

AugmentedBoat BoatWith(std::string_view name, std::vector<double> values) {
  return {{testing::StableBoat(), {{FindEffect(name), std::move(values)}}}, {0.0, 100.0}};
}

AugmentedBoat Plain() {
  return {{testing::StableBoat(), {}}, {0.0, 100.0}};
}

Drive SteadyDrive(const AugmentedBoat& boat, const PropellerCommand& delta) {
  return boat.DrivesAlong(Held(delta), 10.0, kStepS, 1).front();
}

// A Runge-Kutta step of order four multiplies by 1 - 6 + 18 - 36 + 54 = 31 where the damping times
// the step is six.
TEST(AugmentedBoat, SlowsDownWhereAStepIsLongerThanItsDampingAllows) {
  constexpr double kDamping = 30.0;  // 1/s
  constexpr double kLongStepS = 0.2;
  VesselModel stiff = testing::StableBoat();
  for (Eigen::VectorXd& theta : stiff.theta) theta.setZero();
  constexpr Eigen::Index kLinearSurge = 3;  // the regressor u
  stiff.theta[IndexOf(Equation::kSurge)][kLinearSurge] = -kDamping;
  const AugmentedBoat boat({stiff, {}}, {0.0, 100.0});
  const std::vector<Drive> still(5);
  double before = 1.0;
  for (const Pose& pose : boat.Simulate({{}, {before, 0.0, 0.0}}, still, 0.0, kLongStepS)) {
    EXPECT_LE(std::abs(pose.nu.u), before);
    before = std::abs(pose.nu.u);
  }
  EXPECT_LT(before, 1e-6);  // e^-30
}

TEST(AugmentedBoat, WithoutEffectsIsTheModel) {
  const VesselModel model = testing::StableBoat();
  const auto commands = testing::VariedCommands(40.0, 5);
  const auto one = Simulate(model, {}, commands, 40.0, kStepS);
  const auto other = Simulate(AugmentedModel{model, {}}, commands, 40.0, kStepS);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    // Commands here change at multiples of the step, so that both hold the same through each.
    EXPECT_NEAR(one[k].state.nu.u, other[k].state.nu.u, 1e-9) << k;
    EXPECT_NEAR(one[k].state.nu.r, other[k].state.nu.r, 1e-9) << k;
    EXPECT_NEAR(one[k].state.eta.x_m, other[k].state.eta.x_m, 1e-8) << k;
  }
}

TEST(AugmentedBoat, HasTheThrustOfTheModelInReverseAndOnEachSide) {
  VesselModel model = testing::StableBoat();
  model.reverse_loss.per_speed = 0.8;
  model.thrust_imbalance = -0.1;
  const AugmentedBoat boat{{model, {}}, {0.0, 100.0}};
  for (const PropellerCommand delta : {PropellerCommand{-0.7, 0.5}, PropellerCommand{-0.6, -0.8}}) {
    const Nu nu{1.3, 0.1, 0.2};
    const NuDot expected = model.Acceleration(nu, delta);
    const Pose after = boat.Advance({{}, nu}, SteadyDrive(boat, delta), 0.0, 1e-6);
    // The velocity after so short a step, less its own rounding.
    EXPECT_NEAR((after.nu.u - nu.u) / 1e-6, expected.u, 1e-5);
    EXPECT_NEAR((after.nu.r - nu.r) / 1e-6, expected.r, 1e-5);
  }
}

TEST(AugmentedBoat, IsDrivenLikeOneWithTheSameThrustAlone) {
  VesselModel model = testing::StableBoat();
  const AugmentedBoat boat{{model, {}}, {0.0, 100.0}};
  EXPECT_TRUE(boat.IsDrivenLike(AugmentedBoat{{model, {}}, {0.0, 100.0}}));
  EXPECT_TRUE(boat.IsDrivenLike(BoatWith("heading_bias", {0.1})));
  EXPECT_FALSE(boat.IsDrivenLike(BoatWith("thruster_delay", {0.3})));
  model.thrust_imbalance = 0.1;
  EXPECT_FALSE(boat.IsDrivenLike(AugmentedBoat{{model, {}}, {0.0, 100.0}}));
}

TEST(AugmentedBoat, WeakensOneSideOnly) {
  const PropellerCommand both{0.6, 0.6};
  const Drive plain = SteadyDrive(Plain(), both);
  const AugmentedBoat boat = BoatWith("thruster_imbalance", {0.25});
  const Nu rest;
  const Pose after = boat.Advance({{}, rest}, SteadyDrive(boat, both), 0.0, 1e-6);
  const Pose before = Plain().Advance({{}, rest}, plain, 0.0, 1e-6);
  // Starting from rest, a step's velocity is acceleration times step.
  EXPECT_NEAR((after.nu.u - before.nu.u) / 1e-6, -0.25 * plain.thrust[0].u, 1e-6);
  EXPECT_NEAR((after.nu.r - before.nu.r) / 1e-6, -0.25 * plain.thrust[0].r, 1e-6);
}

TEST(AugmentedBoat, DelaysCommands) {
  const PropellerCommand ahead{0.5, 0.5};
  const auto plain = Plain().DrivesAlong(Stepped(ahead), 0.0, kStepS, 60);
  const auto late = BoatWith("thruster_delay", {0.3}).DrivesAlong(Stepped(ahead), 0.0, kStepS, 60);
  for (std::size_t k = 6; k < 60; ++k) {
    EXPECT_NEAR(late[k].thrust[0].u, plain[k - 6].thrust[0].u, 1e-9) << k;
  }
}

// T = n abs(n) with n at 1 - exp(-t / tau) of its last value; the drive is the mean through a step.
TEST(AugmentedBoat, LagsInTheSpeedOfItsShafts) {
  constexpr double kTau = 0.4;
  const PropellerCommand ahead{0.5, 0.5};
  const auto plain = Plain().DrivesAlong(Stepped(ahead), 0.0, kStepS, 60);
  const auto lagging =
      BoatWith("thruster_lag", {kTau}).DrivesAlong(Stepped(ahead), 0.0, kStepS, 60);
  const NuDot steady = plain.back().thrust[0];
  for (std::size_t k = 20; k < 60; ++k) {
    const double t = static_cast<double>(k - 20) * kStepS;
    const auto decayed = [&](double tau) {  // mean of exp(-t / tau) through the step
      return tau / kStepS * (std::exp(-t / tau) - std::exp(-(t + kStepS) / tau));
    };
    const double mean = 1.0 - 2.0 * decayed(kTau) + decayed(0.5 * kTau);
    // Two Gauss nodes of a step of an eighth of tau leave some 1e-7 of it.
    EXPECT_NEAR(lagging[k].thrust[0].u, steady.u * mean, 1e-6) << k;
    EXPECT_NEAR(lagging[k].thrust[0].r, steady.r * mean, 1e-6) << k;
  }
}

TEST(AugmentedBoat, GivesNoThrustInAWiderDeadZone) {
  const AugmentedBoat boat = BoatWith("thruster_dead_zone", {0.1});
  EXPECT_DOUBLE_EQ(SteadyDrive(boat, {0.09, -0.09}).thrust[0].u, 0.0);
  EXPECT_DOUBLE_EQ(SteadyDrive(boat, {0.09, -0.09}).thrust[1].u, 0.0);
  EXPECT_NEAR(SteadyDrive(boat, {0.6, 0.6}).thrust[0].u,
              SteadyDrive(Plain(), {0.5, 0.5}).thrust[0].u, 1e-12);
}

TEST(AugmentedBoat, CutsCommandsOff) {
  const AugmentedBoat boat = BoatWith("thruster_saturation", {0.3});
  EXPECT_NEAR(SteadyDrive(boat, {1.0, -0.9}).thrust[0].u,
              SteadyDrive(Plain(), {0.7, -0.7}).thrust[0].u, 1e-12);
  EXPECT_NEAR(SteadyDrive(boat, {0.6, 0.6}).thrust[1].u,
              SteadyDrive(Plain(), {0.6, 0.6}).thrust[1].u, 1e-12);
}

TEST(AugmentedBoat, HoldsAStuckOutput) {
  const auto stuck = [](std::vector<double> values) {
    return SteadyDrive(BoatWith("output_stuck", std::move(values)), {0.8, 0.6});
  };
  const auto commanded = [](double port, double starboard) {
    return SteadyDrive(Plain(), {port, starboard});
  };
  EXPECT_NEAR(stuck({1.0, 0.0, 0.3}).thrust[0].u, commanded(0.3, 0.6).thrust[0].u, 1e-12);
  EXPECT_NEAR(stuck({1.0, 0.0, 0.3}).thrust[1].u, commanded(0.3, 0.6).thrust[1].u, 1e-12);
  EXPECT_NEAR(stuck({0.0, 0.5, 0.2}).thrust[1].u, commanded(0.8, 0.4).thrust[1].u, 1e-12);
}

// From rest at 1 s an output that takes 2 s to full is at (t - 1 s) / 2 s until it is at 0.5.
TEST(AugmentedBoat, MovesSlowOutputsAtTheirRate) {
  const auto drives =
      BoatWith("output_slew", {2.0}).DrivesAlong(Stepped({0.5, -0.5}), 0.0, kStepS, 60);
  for (std::size_t k = 20; k < 60; ++k) {
    const double middle_s = (static_cast<double>(k) + 0.5) * kStepS - 1.0;
    const double output = std::min(middle_s / 2.0, 0.5);
    const Drive expected = SteadyDrive(Plain(), {output, -output});
    EXPECT_NEAR(drives[k].thrust[0].u, expected.thrust[0].u, 1e-9) << k;
    EXPECT_NEAR(drives[k].thrust[1].r, expected.thrust[1].r, 1e-9) << k;
  }
}

// Water that carries a boat along at its own speed does nothing to it, whatever the heading.
TEST(AugmentedBoat, DriftsWithTheCurrent) {
  VesselModel model = testing::StableBoat();
  for (const std::size_t j : {0, 1, 2}) {
    model.theta[j][j == 0 ? 4 : 8] = 0.0;  // a constant disturbance of its own would move it
  }
  const AugmentedBoat boat({model, {{FindEffect("current"), {0.2, -0.1}}}}, {0.0, 100.0});
  for (const double psi : {0.0, 0.7, 2.0, -2.5}) {
    const Nu with_water = {std::cos(psi) * 0.2 - std::sin(psi) * 0.1,
                           -std::sin(psi) * 0.2 - std::cos(psi) * 0.1, 0.0};
    const Pose after = boat.Advance({{0.0, 0.0, psi}, with_water}, SteadyDrive(boat, {}), 0.0, 1.0);
    EXPECT_NEAR(after.nu.u, with_water.u, 1e-12) << psi;
    EXPECT_NEAR(after.nu.v, with_water.v, 1e-12) << psi;
    EXPECT_NEAR(after.eta.x_m, 0.2, 1e-12) << psi;
    EXPECT_NEAR(after.eta.y_m, -0.1, 1e-12) << psi;
  }
}

// Of water in a steady field V = G p a particle at p accelerates by G V = G G p. A boat without
// thrust that moves with it goes on to do so.
TEST(AugmentedBoat, DriftsWithACurrentThatShears) {
  VesselModel model = testing::StableBoat();
  for (const std::size_t j : {0, 1, 2}) model.theta[j][j == 0 ? 4 : 8] = 0.0;
  const Eigen::Vector2d middle(20.0, -10.0);
  const AugmentedBoat boat({model, {{FindEffect("current_shear"), {0.01, -0.004, 0.003}}}},
                           {0.0, 100.0, middle});
  Eigen::Matrix2d gradient;
  gradient << 0.003, 0.01, -0.004, -0.003;
  const Eigen::Vector2d from_middle(15.0, 8.0);
  const Eigen::Vector2d place = middle + from_middle;
  const Eigen::Vector2d water = gradient * from_middle;
  for (const double psi : {0.0, 0.7, -2.5}) {
    const Eigen::Rotation2Dd to_body(-psi);
    const Eigen::Vector2d nu = to_body * water;
    const double step_s = 1e-3;
    const Pose after = boat.Advance({{place[0], place[1], psi}, {nu[0], nu[1], 0.0}},
                                    SteadyDrive(boat, {}), 0.0, step_s);
    const Eigen::Vector2d accelerated = to_body * (gradient * gradient * from_middle);
    EXPECT_NEAR((after.nu.u - nu[0]) / step_s, accelerated[0], 1e-7) << psi;
    EXPECT_NEAR((after.nu.v - nu[1]) / step_s, accelerated[1], 1e-7) << psi;
  }
  const Pose still =
      boat.Advance({{middle[0], middle[1], 0.7}, {}}, SteadyDrive(boat, {}), 0.0, 1.0);
  EXPECT_NEAR(still.nu.u, 0.0, 1e-12);
}

TEST(AugmentedBoat, DeviatesAsTheDeviationCurveSays) {
  const AugmentedBoat boat = BoatWith("magnetic_deviation", {0.05, -0.03, 0.02, 0.01});
  for (const double psi : {0.0, 0.5 * std::numbers::pi, std::numbers::pi, 4.0}) {
    const double error = 0.05 * std::sin(psi) - 0.03 * std::cos(psi) + 0.02 * std::sin(2.0 * psi) +
                         0.01 * std::cos(2.0 * psi);
    const double slope = 1.0 + 0.05 * std::cos(psi) + 0.03 * std::sin(psi) +
                         0.04 * std::cos(2.0 * psi) - 0.02 * std::sin(2.0 * psi);
    EXPECT_NEAR(boat.MeasuredHeadingRad(psi), psi + error, 1e-12) << psi;
    EXPECT_NEAR(boat.MeasuredHeadingSlope(psi), slope, 1e-7) << psi;
    EXPECT_NEAR(boat.TrueHeadingRad(psi + error), psi, 1e-6) << psi;
  }
}

// A load obeys the law of motion of a point mass at x forward: what it takes of the boat's own
// accelerations is p (u_dot - v r - x r^2) ahead, p_v (v_dot + u r + x r_dot) to starboard and
// p_r (v_dot + u r + x r_dot) about the centre, shares as in core/effects/payload.cpp: sway carries
// 1.5, yaw 1.3 times the dry mass and inertia, and the radius of gyration is 0.4 m.
TEST(AugmentedBoat, CarriesALoadByTheLawOfMotionOfAPointMass) {
  constexpr double kMassGain = 1.0;
  constexpr double kForward = 0.3;
  const AugmentedBoat boat = BoatWith("payload", {kMassGain, kForward});
  const Drive drive = SteadyDrive(Plain(), {0.8, 0.4});
  const Nu nu{0.7, 0.2, 0.5};
  const double step_s = 1e-6;
  const auto acceleration = [&](const AugmentedBoat& simulated) {
    const Pose after = simulated.Advance({{}, nu}, drive, 0.0, step_s);
    return NuDot{(after.nu.u - nu.u) / step_s, (after.nu.v - nu.v) / step_s,
                 (after.nu.r - nu.r) / step_s};
  };
  const NuDot light = acceleration(Plain());
  const NuDot heavy = acceleration(boat);
  const double ahead = heavy.u - nu.v * nu.r - kForward * nu.r * nu.r;
  const double aside = heavy.v + nu.u * nu.r + kForward * heavy.r;
  const double inertia = 1.3 * 0.4 * 0.4;
  // Differences over the step are good to its size times the boat's own rates, about 1 / s.
  EXPECT_NEAR(heavy.u + kMassGain * ahead, light.u, 1e-4);
  EXPECT_NEAR(heavy.v + kMassGain / 1.5 * aside, light.v, 1e-4);
  EXPECT_NEAR(heavy.r + kMassGain * kForward / inertia * aside, light.r, 1e-4);
}

// Two hulls a distance b apart, each with half the drag in the flow that it sees, u -+ r b / 2,
// brake a turn by (b/2)^2 times the slope of the drag; k of it comes with k of the drag.
TEST(AugmentedBoat, BrakesATurnByTheSlopeOfAFouledHullsDrag) {
  constexpr double kGain = 0.4;
  constexpr double kTurning = 0.7;
  const AugmentedBoat boat = BoatWith("hull_fouling", {kGain, kTurning});
  const Drive drive = SteadyDrive(Plain(), {0.0, 0.0});
  const double step_s = 1e-6;
  const auto gained = [&](const Nu& nu) {
    const Pose fouled = boat.Advance({{}, nu}, drive, 0.0, step_s);
    const Pose clean = Plain().Advance({{}, nu}, drive, 0.0, step_s);
    return NuDot{(fouled.nu.u - clean.nu.u) / step_s, 0.0, (fouled.nu.r - clean.nu.r) / step_s};
  };
  const double near = 1e-3;
  const double slope =
      (gained({0.7 + near, 0.0, 0.0}).u - gained({0.7 - near, 0.0, 0.0}).u) / (2.0 * near);
  EXPECT_LT(slope, -0.01);  // or there would be no drag to grow
  EXPECT_NEAR(gained({0.7, 0.0, 0.3}).r, kTurning * slope * 0.3, 1e-4);
  EXPECT_EQ(gained({0.0, 0.0, 0.3}).r, 0.0);
}

// Mirrored: a port loss to a boat that turns to port is a starboard loss to one that turns to
// starboard, for a boat alike on both sides.
TEST(AugmentedBoat, TreatsPortAndStarboardAlike) {
  VesselModel model = testing::StableBoat();
  for (const std::size_t j : {1, 2}) model.theta[j][8] = 0.0;
  const auto simulate = [&](double loss, double port, double starboard) {
    const AugmentedModel boat{model, {{FindEffect("thruster_imbalance"), {loss}}}};
    return Simulate(boat, {{0.0, {port, starboard}}}, 20.0, kStepS).back().state;
  };
  const VesselState one = simulate(0.3, 0.7, 0.4);
  const VesselState other = simulate(-0.3, 0.4, 0.7);
  EXPECT_NEAR(one.nu.u, other.nu.u, 1e-12);
  EXPECT_NEAR(one.nu.v, -other.nu.v, 1e-12);
  EXPECT_NEAR(one.nu.r, -other.nu.r, 1e-12);
  EXPECT_NEAR(one.eta.y_m, -other.eta.y_m, 1e-10);
}

TEST(AugmentedMeasure, ShowsAFaultySensorChain) {
  const VesselModel model = testing::StableBoat();
  const auto track = Simulate(AugmentedModel{model, {}}, {{0.0, {0.5, 0.3}}}, 10.0, kStepS);
  const Vehicle vehicle = testing::StableBoatVehicle();
  const auto plain = Measure(track, AugmentedModel{model, {}}, vehicle, testing::NoNoise());
  const AugmentedModel turned{model, {{FindEffect("heading_bias"), {0.1}}}};
  const AugmentedModel late{model, {{FindEffect("gnss_latency"), {0.25}}}};
  const auto by_turned = Measure(track, turned, vehicle, testing::NoNoise());
  const auto by_late = Measure(track, late, vehicle, testing::NoNoise());
  const double off = by_turned.heading[50].heading_deg - plain.heading[50].heading_deg;
  EXPECT_NEAR(std::remainder(off, 360.0), 0.1 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(by_late.gnss[10].time_s - plain.gnss[10].time_s, 0.25, 1e-12);
  EXPECT_EQ(by_late.gnss[10].latitude_deg, plain.gnss[10].latitude_deg);
}

}  // namespace
}  // namespace telltale
