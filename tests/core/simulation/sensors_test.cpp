#include "telltale/core/simulation/sensors.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <GeographicLib/Geodesic.hpp>

#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"

namespace telltale {
namespace {

Vehicle PlainVehicle() {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.gnss_antenna = {};
  return vehicle;
}

std::vector<TimedState> Resting(double duration_s, const Eta& eta,
                                const PropellerCommand& delta = {}) {
  std::vector<TimedState> track;
  const int steps = static_cast<int>(std::lround(duration_s / 0.02));
  for (int k = 0; k <= steps; ++k) track.push_back({0.02 * k, {eta, {}}, delta});
  return track;
}

// The geodesic from the frame's origin to a fix, as metres north and east.
Eigen::Vector2d FromOrigin(const SensorOptions& options, const GnssFix& fix) {
  double distance_m = 0.0;
  double bearing_deg = 0.0;
  double unused = 0.0;
  GeographicLib::Geodesic::WGS84().Inverse(options.origin.latitude_deg,
                                           options.origin.longitude_deg, fix.latitude_deg,
                                           fix.longitude_deg, distance_m, bearing_deg, unused);
  const double bearing = bearing_deg * std::numbers::pi / 180.0;
  return {distance_m * std::cos(bearing), distance_m * std::sin(bearing)};
}

SensorOptions Noiseless() {
  SensorOptions options;
  options.position_noise_m = 0.0;
  options.heading_noise_deg = 0.0;
  return options;
}

TEST(Measure, SamplesEachSensorAtItsRate) {
  const Recording recording = Measure(Resting(10.0, {}), PlainVehicle(), {});
  EXPECT_EQ(recording.gnss.size(), 51u);
  EXPECT_EQ(recording.heading.size(), 501u);
  EXPECT_EQ(recording.thrusters.size(), 101u);
  EXPECT_NEAR(recording.gnss[7].time_s, 1.4, 1e-12);
  EXPECT_NEAR(recording.heading[499].time_s, 9.98, 1e-12);
  EXPECT_NEAR(recording.thrusters[3].time_s, 0.3, 1e-12);
}

TEST(Measure, PutsTheAntennaWhereItIsOnTheEarth) {
  Vehicle vehicle = PlainVehicle();
  vehicle.gnss_antenna = {2.0, 0.5};
  const SensorOptions options = Noiseless();
  const Eta east{30.0, -40.0, std::numbers::pi / 2};
  const Recording recording = Measure(Resting(1.0, east), vehicle, options);
  const Eigen::Vector2d antenna = FromOrigin(options, recording.gnss.front());
  // Facing east, forward is east and starboard is south. The plane and the ellipsoid part by less
  // than a micrometre at 50 m.
  EXPECT_NEAR(antenna.x(), 30.0 - 0.5, 1e-5);
  EXPECT_NEAR(antenna.y(), -40.0 + 2.0, 1e-5);
}

TEST(Measure, InterpolatesBetweenStates) {
  std::vector<TimedState> track = {{0.0, {{0.0, 0.0, 0.0}, {}}, {}},
                                   {1.0, {{5.0, 0.0, 1.0}, {}}, {}}};
  const SensorOptions options = Noiseless();
  const Recording recording = Measure(track, PlainVehicle(), options);
  ASSERT_EQ(recording.gnss.size(), 6u);
  EXPECT_NEAR(FromOrigin(options, recording.gnss[2]).x(), 2.0, 1e-5);
  EXPECT_NEAR(recording.heading[10].heading_deg, 0.2 * 180.0 / std::numbers::pi, 1e-9);
}

TEST(Measure, WrapsHeadingsIntoOneTurn) {
  for (const double psi_rad : {-0.1, 7.0, -20.0, 100.0, 0.0, -1e-18}) {
    const Recording recording =
        Measure(Resting(0.1, {0.0, 0.0, psi_rad}), PlainVehicle(), Noiseless());
    const double heading_deg = recording.heading.front().heading_deg;
    EXPECT_GE(heading_deg, 0.0);
    EXPECT_LT(heading_deg, 360.0);
    EXPECT_NEAR(WrapAngle(heading_deg * std::numbers::pi / 180.0 - psi_rad), 0.0, 1e-12);
  }
}

TEST(Measure, RoundsPulseWidthsToAMicrosecond) {
  Vehicle vehicle = PlainVehicle();
  vehicle.starboard = {1511.0, 1111.0, 1911.0};
  const Recording recording = Measure(Resting(0.2, {}, {0.3337, 0.25}), vehicle, {});
  EXPECT_EQ(recording.thrusters.front().port_us, 1633.0);  // 1500 + 133.48
  EXPECT_EQ(recording.thrusters.front().starboard_us, 1411.0);
}

TEST(Measure, NoiseHasTheAskedForSizeAndIsUnbiased) {
  SensorOptions options;
  options.position_noise_m = 0.02;
  options.heading_noise_deg = 0.3;
  options.seed = 5;
  const Recording recording =
      Measure(Resting(2000.0, {0.0, 0.0, std::numbers::pi}), PlainVehicle(), options);
  Eigen::ArrayXd north(recording.gnss.size());
  Eigen::ArrayXd east(recording.gnss.size());
  for (std::size_t k = 0; k < recording.gnss.size(); ++k) {
    const Eigen::Vector2d fix = FromOrigin(options, recording.gnss[k]);
    north[k] = fix.x();
    east[k] = fix.y();
  }
  Eigen::ArrayXd heading(recording.heading.size());
  for (std::size_t k = 0; k < recording.heading.size(); ++k) {
    heading[k] = recording.heading[k].heading_deg - 180.0;
  }
  // Five standard errors: sigma / sqrt(n) of a mean, sigma / sqrt(2 n) of a root mean square.
  const auto expect_white = [](const Eigen::ArrayXd& noise, double sigma) {
    const double n = static_cast<double>(noise.size());
    EXPECT_NEAR(noise.mean(), 0.0, 5.0 * sigma / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(noise.square().mean()), sigma, 5.0 * sigma / std::sqrt(2.0 * n));
    const double lag_one = (noise.head(noise.size() - 1) * noise.tail(noise.size() - 1)).mean();
    EXPECT_NEAR(lag_one / (sigma * sigma), 0.0, 5.0 / std::sqrt(n));
  };
  expect_white(north, 0.02);
  expect_white(east, 0.02);
  expect_white(heading, 0.3);
  EXPECT_NEAR((north * east).mean() / (0.02 * 0.02), 0.0,
              5.0 / std::sqrt(static_cast<double>(north.size())));
}

TEST(Measure, SameSeedSameBits) {
  const auto track = Simulate(YellowfishTwin(), {}, SampleMission(1), 20.0, 0.02);
  SensorOptions options;
  options.seed = 9;
  const Recording one = Measure(track, YellowfishVehicle(), options);
  const Recording same = Measure(track, YellowfishVehicle(), options);
  options.seed = 10;
  const Recording other = Measure(track, YellowfishVehicle(), options);
  for (std::size_t k = 0; k < one.gnss.size(); ++k) {
    EXPECT_EQ(one.gnss[k].latitude_deg, same.gnss[k].latitude_deg);
    EXPECT_EQ(one.gnss[k].longitude_deg, same.gnss[k].longitude_deg);
  }
  for (std::size_t k = 0; k < one.heading.size(); ++k) {
    EXPECT_EQ(one.heading[k].heading_deg, same.heading[k].heading_deg);
  }
  EXPECT_NE(one.gnss[3].latitude_deg, other.gnss[3].latitude_deg);
  EXPECT_NE(one.heading[3].heading_deg, other.heading[3].heading_deg);
}

}  // namespace
}  // namespace telltale
