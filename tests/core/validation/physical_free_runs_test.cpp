#include "telltale/core/validation/physical_free_runs.hpp"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

constexpr double kSeparationM = 0.62;
constexpr double kFixDelayS = 0.1;

PhysicalModel TrueModel() {
  FossenVector p;
  p << 1.5, 0.03, 0.18, 0.15, 0.45, 1.2, 0.05, -0.05, 0.25, 1.5, 0.4, -0.1, 0.05, 0.2, 0.3, 0.0,
      0.0, 0.1, 0.5, 1.6, 0.4, 1.2, 0.5, 0.04, 0.06, 0.08, 0.1, 0.0, kFixDelayS;
  PhysicalModel model;
  for (const double estimate : p) {
    Coefficient parameter;
    parameter.estimate = estimate;
    model.parameters.push_back(parameter);
  }
  model.propeller_separation_m = kSeparationM;
  model.noise.acceleration_sigma.setConstant(0.01);
  model.noise.fix_drift_sigma_m = 0.001;
  model.noise.fix_sigma_m = 0.001;
  model.noise.heading_sigma_rad = 0.0002;
  model.noise.stamp_sigma_s = 0.001;
  return model;
}

Vehicle FreeRunVehicle() {
  Vehicle vehicle;
  vehicle.propeller_separation_m = kSeparationM;
  vehicle.gnss_antenna = {0.3, 0.1};
  return vehicle;
}

PreparedDataset FiveMinutes() {
  const VesselModel model = VesselModelOf(TrueModel().Estimates(), kSeparationM);
  SensorOptions sensors;
  sensors.thruster_period_s = 0.02;  // as often as the commands can change
  sensors.position_noise_m = 0.001;
  sensors.heading_noise_deg = 0.01;
  Recording recording =
      Measure(Simulate(model, {}, SampleMission(1), 300.0, 0.02), FreeRunVehicle(), sensors);
  for (GnssFix& fix : recording.gnss) fix.time_s += kFixDelayS;
  return *Prepare(recording, FreeRunVehicle(), PrepareOptions::Robust());
}

// Where a command steps, the filter of the dataset changes the surge velocity by 0.1 m/s and more:
// 2 m/s^2 over a part of its window of 3.2 s. Predictions that have not passed it err by that all
// along a run with a step. With noise of a millimetre and the true model hardly anything else is
// left.
TEST(PhysicalFreeRuns, OfTheTrueModelMatchTheRowsAtStepsOfTheCommand) {
  const PreparedDataset dataset = FiveMinutes();
  const PhysicalModel model = TrueModel();
  const PhysicalFreeRuns runs(dataset, model);
  constexpr std::size_t kRows = 25;
  constexpr double kSettledS = 30.0;  // the filter knows the current by then
  std::size_t count = 0;
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  runs.RunAll(kRows, [&](std::size_t first, const std::vector<PreparedRow>& predicted) {
    ASSERT_EQ(predicted.size(), kRows + 1);
    if (dataset.rows[first].time_s < kSettledS) return;
    for (std::size_t k = 1; k <= kRows; ++k) {
      const Nu& recorded = dataset.rows[first + k].nu;
      const Nu& nu = predicted[k].nu;
      squares += Eigen::Array3d(nu.u - recorded.u, nu.v - recorded.v, nu.r - recorded.r).square();
    }
    ++count;
  });
  const Eigen::Array3d rmse = (squares / static_cast<double>(count * kRows)).sqrt();
  EXPECT_GT(count, 50U);
  for (const double error : rmse) EXPECT_LT(error, 0.01);
}

TEST(PhysicalFreeRuns, StartAtTheRecordedPosition) {
  const PreparedDataset dataset = FiveMinutes();
  const PhysicalModel model = TrueModel();
  PhysicalFreeRuns(dataset, model).RunAll(25, [&](std::size_t first, const auto& predicted) {
    EXPECT_DOUBLE_EQ(predicted.front().eta.x_m, dataset.rows[first].eta.x_m);
    EXPECT_DOUBLE_EQ(predicted.front().eta.y_m, dataset.rows[first].eta.y_m);
  });
}

// 2 s of the segment's last rows: the filter's whole window lies before its end.
TEST(PhysicalFreeRuns, ReachTheEndOfTheSegment) {
  const PreparedDataset dataset = FiveMinutes();
  const PhysicalModel model = TrueModel();
  std::size_t last = 0;
  PhysicalFreeRuns(dataset, model).RunAll(1, [&](std::size_t first, const auto&) { last = first; });
  EXPECT_EQ(last + 2, dataset.rows.size());
}

}  // namespace
}  // namespace telltale
