#include "telltale/core/simulation/synthetic_dataset.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "support/stable_boat.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/preparation.hpp"

namespace telltale {
namespace {

PreparedDataset SimulatedDataset(const SensorOptions& sensors, double longest_segment_s = 40.0) {
  PrepareOptions options;
  options.smoothing_half_width = 4;
  options.longest_segment_s = longest_segment_s;
  return *Prepare(testing::SimulateStableBoat(testing::StableBoat(), 120.0, sensors, 2),
                  testing::StableBoatVehicle(), options);
}

TEST(SyntheticDataset, WithoutNoiseOrDisturbanceFollowsTheSameCourse) {
  const PreparedDataset dataset = SimulatedDataset(testing::NoNoise());
  const auto synthetic = SimulateDataset(dataset, testing::StableBoat(), {});
  ASSERT_TRUE(synthetic.has_value());
  ASSERT_EQ(synthetic->segments.size(), dataset.segments.size());
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& before = dataset.segments[s];
    const RowRange& after = synthetic->segments[s];
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      // It starts from filtered velocities, which a step of the command next to the start bends.
      const Nu& a = dataset.rows[before.begin + k].nu;
      const Nu& b = synthetic->rows[after.begin + k].nu;
      EXPECT_NEAR(a.u, b.u, 0.04);
      EXPECT_NEAR(a.v, b.v, 0.04);
      EXPECT_NEAR(a.r, b.r, 0.06);
      EXPECT_EQ(dataset.rows[before.begin + k].region, synthetic->rows[after.begin + k].region);
    }
  }
}

// The bias correction takes a bias of synthetic datasets for that of the estimator, so that the
// simulation itself has none.
TEST(SyntheticDataset, TurnsAsTheBoatDoesOnceItsStartHasDecayed) {
  constexpr double kForgottenS = 10.0;
  const PreparedDataset dataset = SimulatedDataset(testing::NoNoise());
  const auto synthetic = SimulateDataset(dataset, testing::StableBoat(), {});
  ASSERT_TRUE(synthetic.has_value());
  const auto after = static_cast<std::size_t>(kForgottenS / dataset.sampling_period_s);
  double off = 0.0;
  double turning = 0.0;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    for (std::size_t k = after; k < dataset.segments[s].size(); ++k) {
      const double r = dataset.rows[dataset.segments[s].begin + k].nu.r;
      off += std::pow(synthetic->rows[synthetic->segments[s].begin + k].nu.r - r, 2);
      turning += r * r;
    }
  }
  // Poses that follow the mean of both ends of a step, or two headings a row, are 5e-4 off. What is
  // left is that of the recording, made in steps of 0.02 s.
  EXPECT_LT(std::sqrt(off / turning), 3.5e-4);
}

TEST(SyntheticDataset, HasTheNoiseOfTheDataset) {
  SensorOptions sensors;
  sensors.position_noise_m = 0.03;
  sensors.heading_noise_deg = 0.4;
  const PreparedDataset dataset = SimulatedDataset(sensors);
  const auto synthetic = SimulateDataset(dataset, testing::StableBoat(), {});
  ASSERT_TRUE(synthetic.has_value());
  // Medians of some hundred differences know a sigma to about 5 %.
  EXPECT_NEAR(synthetic->sensors.position_noise_m, 0.03, 0.006);
  EXPECT_NEAR(synthetic->nu_noise.u, dataset.nu_noise.u, 0.2 * dataset.nu_noise.u);
  EXPECT_NEAR(synthetic->nu_noise.r, dataset.nu_noise.r, 0.2 * dataset.nu_noise.r);
}

TEST(SyntheticDataset, HasGnssDrift) {
  const PreparedDataset dataset = SimulatedDataset(testing::NoNoise());
  SyntheticDatasetOptions options;
  const auto still = SimulateRecording(dataset, testing::StableBoat(), options);
  options.disturbance.gnss_drift_m = 0.05;
  const auto drifting = SimulateRecording(dataset, testing::StableBoat(), options);
  ASSERT_TRUE(still && drifting);
  const NorthEastFrame frame(dataset.origin);
  std::vector<Eigen::Vector2d> off;
  for (std::size_t i = 0; i < still->recording.gnss.size(); ++i) {
    const auto place = [&](const SyntheticRecording& synthetic) {
      const GnssFix& fix = synthetic.recording.gnss[i];
      const NorthEastPosition at = frame.Forward({fix.latitude_deg, fix.longitude_deg});
      return Eigen::Vector2d(at.north_m, at.east_m);
    };
    off.push_back(place(*drifting) - place(*still));
  }
  const auto a_second = static_cast<std::size_t>(std::lround(1.0 / dataset.sensors.gnss_period_s));
  double square = 0.0;
  for (std::size_t i = a_second; i < off.size(); ++i) {
    square += 0.5 * (off[i] - off[i - a_second]).squaredNorm();
  }
  // 120 seconds, two axes: known to 5 %; three times that.
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(off.size() - a_second)), 0.05, 0.0075);
}

TEST(SyntheticDataset, RepeatsItselfBitForBitFromASeed) {
  const PreparedDataset dataset = SimulatedDataset(SensorOptions{});
  SyntheticDatasetOptions options;
  options.disturbance.sigma.setConstant(0.05);
  options.disturbance.time_constant_s.setConstant(3.0);
  const auto once = SimulateDataset(dataset, testing::StableBoat(), options);
  const auto twice = SimulateDataset(dataset, testing::StableBoat(), options);
  options.seed = 2;
  const auto other = SimulateDataset(dataset, testing::StableBoat(), options);
  ASSERT_TRUE(once && twice && other);
  EXPECT_EQ(once->rows[100].nu.u, twice->rows[100].nu.u);
  EXPECT_NE(once->rows[100].nu.u, other->rows[100].nu.u);
}

TEST(SyntheticDataset, RefusesABoatThatDiverges) {
  VesselModel diverging = testing::StableBoat();
  diverging.theta[0][0] = 3.0;
  diverging.theta[0][3] = 3.0;
  const auto synthetic = SimulateDataset(SimulatedDataset(testing::NoNoise()), diverging, {});
  ASSERT_FALSE(synthetic.has_value());
  EXPECT_EQ(synthetic.error().subject, "synthetic dataset");
}

}  // namespace
}  // namespace telltale
