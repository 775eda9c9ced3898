#include "telltale/core/effects/sensor_chain.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

constexpr double kStepS = 0.1;
constexpr LeverArm kStated = {0.3, -0.1};

/// A boat that turns at a constant rate, ahead at 1 m/s and with a sway.
Pose TrueAt(double time_s) {
  constexpr double kU = 1.0, kV = 0.2, kR = 0.3;
  const double psi = 0.4 + kR * time_s;
  const auto north = [&](double at) { return (kU * std::sin(at) + kV * std::cos(at)) / kR; };
  const auto east = [&](double at) { return (-kU * std::cos(at) + kV * std::sin(at)) / kR; };
  return {{north(psi) - north(0.4), east(psi) - east(0.4), psi}, {kU, kV, kR}};
}

AugmentedBoat BoatWithFaultySensors() {
  return {{testing::StableBoat(),
           {{FindEffect("heading_bias"), {0.2}},
            {FindEffect("magnetic_deviation"), {0.05, -0.04, 0.02, 0.03}},
            {FindEffect("antenna_lever_arm"), {0.5, 0.25}},
            {FindEffect("gnss_latency"), {3.0 * kStepS}}}},
          {0.0, 100.0}};
}

/// What such sensors make of the boat, row by row.
PreparedDataset MeasuredBy(const AugmentedBoat& boat, std::size_t rows) {
  PreparedDataset dataset;
  dataset.sampling_period_s = kStepS;
  dataset.sensors.antenna = kStated;
  for (std::size_t k = 0; k < rows; ++k) {
    const double time_s = kStepS * static_cast<double>(k);
    const Pose measured =
        MeasuredPose(TrueAt(time_s), TrueAt(time_s - boat.LatencyS()), kStated, boat);
    PreparedRow row;
    row.time_s = time_s;
    row.eta = measured.eta;
    row.nu = measured.nu;
    dataset.rows.push_back(row);
  }
  dataset.segments = {{0, rows}};
  return dataset;
}

TEST(MeasuredPose, IsTheInverseOfTrueStart) {
  const AugmentedBoat boat = BoatWithFaultySensors();
  const PreparedDataset dataset = MeasuredBy(boat, 40);
  for (const double time_s : {0.0, 1.0, 2.5}) {
    const Pose truth = TrueAt(time_s);
    const Pose found = TrueStart(dataset, dataset.segments.front(), time_s, boat);
    EXPECT_NEAR(found.eta.x_m, truth.eta.x_m, 1e-6);
    EXPECT_NEAR(found.eta.y_m, truth.eta.y_m, 1e-6);
    EXPECT_NEAR(found.eta.psi_rad, truth.eta.psi_rad, 1e-6);
    EXPECT_NEAR(found.nu.u, truth.nu.u, 1e-6);
    EXPECT_NEAR(found.nu.v, truth.nu.v, 1e-6);
    EXPECT_NEAR(found.nu.r, truth.nu.r, 1e-6);
  }
}

// An antenna half a metre ahead of where it is stated shows the boat half a metre ahead.
TEST(MeasuredPose, IsOffByTheAntennasShift) {
  const AugmentedBoat boat({testing::StableBoat(), {{FindEffect("antenna_lever_arm"), {0.5, 0.0}}}},
                           {0.0, 100.0});
  const Pose truth = TrueAt(0.0);
  const Pose measured = MeasuredPose(truth, truth, {}, boat);
  EXPECT_NEAR(measured.eta.x_m, truth.eta.x_m + 0.5 * std::cos(truth.eta.psi_rad), 1e-12);
  EXPECT_NEAR(measured.eta.y_m, truth.eta.y_m + 0.5 * std::sin(truth.eta.psi_rad), 1e-12);
  EXPECT_EQ(measured.eta.psi_rad, truth.eta.psi_rad);
}

}  // namespace
}  // namespace telltale
