#include "telltale/core/effects/hull_scale.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"
#include "telltale/core/effects/augmented_boat.hpp"

namespace telltale {
namespace {

/// What an effect adds for a hull, at an instant that is at rest heading north but for `instant`.
NuDot Added(std::string_view effect, const std::vector<double>& values, const HullParticulars& hull,
            InstantState instant = {}) {
  instant.hull_scale = HullScale(hull);
  return FindEffect(effect)->AddedAcceleration(values, instant);
}

InstantState Thrusting(double surge) {
  InstantState instant;
  instant.thrust[0].u = surge;
  return instant;
}

InstantState Turning(double yaw_acceleration) {
  InstantState instant;
  instant.hull.yaw[0] = yaw_acceleration;
  return instant;
}

TEST(HullScale, OfTheDefaultHullIsExactlyOne) {
  const HullScale scale{HullParticulars{}};
  EXPECT_EQ(scale.length, 1.0);
  EXPECT_EQ(scale.beam, 1.0);
  EXPECT_EQ(scale.frontal_area, 1.0);
  EXPECT_EQ(scale.lateral_area, 1.0);
  EXPECT_EQ(scale.mass, 1.0);
  EXPECT_EQ(scale.gyration_radius_m, 0.4);
  EXPECT_EQ(scale.SwayMassRatio(), 1.0);
  EXPECT_EQ(scale.YawInertiaRatio(), 1.0);
}

TEST(HullScale, AddedMassGoesWithDraughtSquaredAndLengthOverMass) {
  const HullScale scale{{.length_m = 2.6, .draught_m = 0.24, .mass_kg = 70.0}};
  EXPECT_NEAR(scale.sway_mass, 1.0 + 0.5 * 4.0, 1e-12);
  EXPECT_NEAR(scale.yaw_inertia, 1.0 + 0.3 * 4.0, 1e-12);
  EXPECT_NEAR(scale.gyration_radius_m, 0.8, 1e-12);
}

TEST(WindOfTheDefaultHull, HasTheCoefficientsOfTheLibrary) {
  // At rest heading north: V_rw = (3, 4), |V_rw| = 5.
  const NuDot added = Added("wind", {3.0, 4.0, 0.9, 0.5, 0.0, 1.0}, {});
  EXPECT_DOUBLE_EQ(added.u, 0.0028 * 5.0 * 3.0);
  EXPECT_DOUBLE_EQ(added.v, 0.0040 * 0.9 * 5.0 * 4.0);
  EXPECT_DOUBLE_EQ(added.r, 0.0045 * 0.5 * 3.0 * 4.0);
}

// A side force (m + A22) v_dot that acts s L ahead turns the boat by that moment over I + A66, with
// (m + A22) / m = 1.5, (I + A66) / I = 1.3 and I = m (0.4 m)^2.
TEST(WindOfTheDefaultHull, TurnsTheBoatAboutItsLateralAreasCentre) {
  constexpr double kCentre = 0.1;
  const NuDot added = Added("wind", {0.0, 5.0, 1.0, 0.0, kCentre, 1.0}, {});
  EXPECT_NEAR(added.r, kCentre * 1.3 * 1.5 / (1.3 * 0.16) * added.v, 1e-12);
}

TEST(WindOfAStatedHull, GoesWithAreaOverMassAndInertia) {
  const std::vector<double> values = {3.0, 4.0, 0.9, 0.5, 0.1, 1.0};
  const NuDot plain = Added("wind", values, {});
  const NuDot larger = Added("wind", values, {.frontal_area_m2 = 0.5, .lateral_area_m2 = 1.2});
  EXPECT_NEAR(larger.u, 2.0 * plain.u, 1e-12);
  EXPECT_NEAR(larger.v, 3.0 * plain.v, 1e-12);
  EXPECT_NEAR(larger.r, 3.0 * plain.r, 1e-12);
  // Twice as long and twice as heavy: the share of added mass is the same.
  const NuDot longer = Added("wind", values, {.length_m = 2.6, .mass_kg = 70.0});
  EXPECT_NEAR(longer.u, plain.u / 2.0, 1e-12);
  EXPECT_NEAR(longer.v, plain.v / 2.0, 1e-12);
  EXPECT_NEAR(longer.r, plain.r / 4.0, 1e-12);
}

// v_dot (1 + p_v) + p_v x r_dot = 0 and r_dot (1 + p_r x) + p_r v_dot = N of a boat whose hull
// turns it by N, with p_v = p / 1.5 and p_r = p x / (1.3 k^2).
TEST(PayloadOfAStatedHull, GoesWithTheRadiusOfGyrationOfItsLength) {
  constexpr double kGain = 0.5;
  constexpr double kForward = 0.3;
  constexpr double kYaw = 0.7;
  for (const auto& [hull, k] :
       {std::pair(HullParticulars{}, 0.4),
        std::pair(HullParticulars{.length_m = 2.6, .mass_kg = 70.0}, 0.8)}) {
    const NuDot added = Added("payload", {kGain, kForward}, hull, Turning(kYaw));
    const double p_v = kGain / 1.5;
    const double p_r = kGain * kForward / (1.3 * k * k);
    const double r_dot = kYaw + added.r;
    EXPECT_NEAR((1.0 + p_v) * added.v + p_v * kForward * r_dot, 0.0, 1e-12) << k;
    EXPECT_NEAR((1.0 + p_r * kForward) * r_dot + p_r * added.v, kYaw, 1e-12) << k;
  }
}

// A load amidships of p = 0.4 sinks the default hull by s = 0.3 of its draught: its wetted surface
// is (1.82 * 1.3 + 1.4 / 1.3) / 2.82 times as large, its damping across 1.3 times, its added mass
// 1.69 times. Sway carries 0.5 and yaw 0.3 of the dry mass and inertia as added ones.
TEST(LoadThatSinksTheHull, GrowsDragDampingAndAddedMassWithTheDraught) {
  InstantState instant;
  instant.nu = instant.nu_r = {0.8, 0.1, 0.3};
  instant.hull.surge = {-0.2, 0.0, 0.0, -0.1};
  instant.hull.sway = {-0.3, 0.0, 0.0, 0.0, 0.0, 0.0, -0.2, -0.1};
  instant.hull.yaw = {0.0, 0.0, 0.0, -0.4, 0.0, 0.0, 0.0, -0.6};
  instant.thrust[0].u = 0.5;
  const NuDot added = Added("trim_sinkage", {0.4, 0.0, 1.0, 1.0}, {}, instant);
  const double wetted = (1.82 * 1.3 + 1.4 / 1.3) / 2.82;
  const double carried = 0.5 * 0.69;
  EXPECT_NEAR(1.4 * (0.5 - 0.3 + added.u),
              0.5 - 0.3 * wetted + 0.4 * 0.1 * 0.3 + carried * 0.1 * 0.3, 1e-12);
  EXPECT_NEAR((1.0 + (0.4 + carried) / 1.5) * (-0.6 + added.v), -0.6 * 1.3 - 0.4 / 1.5 * 0.8 * 0.3,
              1e-12);
  EXPECT_NEAR((1.0 + 0.69 * 0.3 / 1.3) * (-1.0 + added.r),
              -1.0 * 1.3 - carried / (1.3 * 0.16) * 0.8 * 0.1, 1e-12);
}

// Of a load that sinks the hull to 1.3 times its draught: what does not reach deeper damps as
// before, lift of a slender hull goes with the square of the draught. A boat that carries along one
// and a half times as much water as the default hull gains so much more of it.
TEST(LoadThatSinksTheHull, DampsByAPowerOfTheDraughtAndCarriesTheBoatsOwnWater) {
  InstantState instant;
  instant.hull.yaw = {0.0, 0.0, 0.0, -0.4, 0.0, 0.0, 0.0, -0.6};
  for (const auto& [power, damping] :
       {std::pair(0.0, 1.0), std::pair(1.0, 1.3), std::pair(2.0, 1.69)}) {
    for (const double ratio : {1.0, 1.5}) {
      const double slowed = Added("trim_sinkage", {0.4, 0.0, power, ratio}, {}, instant).r - 1.0;
      EXPECT_NEAR((1.0 + ratio * 0.69 * 0.3 / 1.3) * slowed, -damping, 1e-12) << power;
    }
  }
}

// With its bow deeper a hull drags more ahead of its centre: to a side speed it answers with a
// moment towards the bow, t L / 6 times the force.
TEST(LoadThatTrimsTheHull, LeansTheDragAcrossToTheBow) {
  InstantState instant;
  instant.hull.sway = {-0.3};
  instant.nu = instant.nu_r = {0.0, 0.5, 0.0};
  const double amidships = Added("trim_sinkage", {0.01, 0.0, 1.0, 1.0}, {}, instant).r;
  const double at_the_bow = Added("trim_sinkage", {0.01, 0.3, 1.0, 1.0}, {}, instant).r;
  const double trim = 5.6 * 0.01 * 0.3 / 1.3;
  const double lever = trim * 1.3 / 6.0 * 1.5 / (1.3 * 0.16);
  // The point mass itself turns the hull by p_r times its own acceleration to the side.
  const double point_mass = 0.01 * 0.3 / (1.3 * 0.16) * 0.3;
  EXPECT_NEAR(amidships, 0.0, 1e-12);
  EXPECT_NEAR(at_the_bow, -0.3 * lever + point_mass, 2e-2 * std::abs(0.3 * lever));
}

TEST(MisalignmentOfAStatedHull, TurnsALongerHullLess) {
  const std::vector<double> values = {0.1, 2.7};
  const NuDot plain = Added("thruster_misalignment", values, {}, Thrusting(0.4));
  EXPECT_DOUBLE_EQ(plain.v, 0.4 * 0.7 * std::sin(0.1));
  EXPECT_DOUBLE_EQ(plain.r, -0.4 * 2.7 * std::sin(0.1));
  const NuDot longer =
      Added("thruster_misalignment", values, {.length_m = 2.6, .mass_kg = 70.0}, Thrusting(0.4));
  EXPECT_NEAR(longer.r, plain.r / 2.0, 1e-12);
  EXPECT_NEAR(longer.v, plain.v, 1e-12);
  const NuDot deeper = Added("thruster_misalignment", values, {.draught_m = 0.24}, Thrusting(0.4));
  EXPECT_NEAR(deeper.v, plain.v * 1.5 / (1.0 + 0.5 * 4.0), 1e-12);
}

TEST(FoulingOfAStatedHull, BrakesATurnByTheSquareOfBeamOverLength) {
  InstantState instant;
  instant.hull.surge[0] = -0.2;
  instant.nu_r = {0.8, 0.0, 0.3};
  const std::vector<double> values = {0.4, 0.5};
  const NuDot plain = Added("hull_fouling", values, {}, instant);
  EXPECT_DOUBLE_EQ(plain.r, 0.4 * 0.5 * (2.0 * -0.2 / 0.8) * 0.3);
  const NuDot longer = Added("hull_fouling", values, {.length_m = 2.6}, instant);
  EXPECT_NEAR(longer.r, plain.r / 4.0, 1e-12);
  EXPECT_EQ(longer.u, plain.u);
  const NuDot wider = Added("hull_fouling", values, {.beam_m = 1.6}, instant);
  EXPECT_NEAR(wider.r, plain.r * 4.0, 1e-12);
}

TEST(HullOfAVehicle, IsTheDefaultHullUnlessStated) {
  Vehicle vehicle;
  vehicle.mass_kg = 15.0;
  EXPECT_EQ(vehicle.HullOrDefault().mass_kg, HullParticulars{}.mass_kg);
  vehicle.hull = HullParticulars{.length_m = 2.0};
  EXPECT_EQ(vehicle.HullOrDefault().length_m, 2.0);
  EXPECT_EQ(vehicle.HullOrDefault().mass_kg, 15.0);
  EXPECT_EQ(vehicle.HullOrDefault().beam_m, HullParticulars{}.beam_m);
}

TEST(HullOfAVehicle, ReachesTheBoatThroughThePreparedDataset) {
  Vehicle vehicle = testing::StableBoatVehicle();
  vehicle.hull = HullParticulars{.frontal_area_m2 = 0.5};
  const AugmentedModel model{testing::StableBoat(),
                             {{FindEffect("wind"), {4.0, 0.0, 1.0, 0.0, 0.0, 1.0}}}};
  const auto track = Simulate(model, testing::VariedCommands(60.0, 3), 60.0, 0.1);
  PrepareOptions options;
  options.sampling_period_s = 0.2;
  const auto dataset =
      Prepare(Measure(track, model, vehicle, testing::NoNoise()), vehicle, options).value();
  const AugmentedBoat stated(model, {0.0, 60.0}, dataset.hull);
  const AugmentedBoat plain(model, {0.0, 60.0});
  const AugmentedBoat calm({testing::StableBoat(), {}}, {0.0, 60.0});
  const auto accelerated = [](const AugmentedBoat& boat) {
    return boat.Advance({}, {}, 0.0, 1e-6).nu.u / 1e-6;
  };
  const double added = accelerated(plain) - accelerated(calm);
  EXPECT_GT(added, 0.01);
  EXPECT_NEAR(accelerated(stated) - accelerated(calm), 2.0 * added, 1e-6);
}

}  // namespace
}  // namespace telltale
