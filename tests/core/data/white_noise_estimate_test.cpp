#include "telltale/core/data/white_noise_estimate.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"

namespace telltale {
namespace {

TEST(WhiteNoise, IsZeroOnACubicUnderAnySampling) {
  TimeSeries cubic;
  RandomEngine engine(3);
  for (double t = 1000.0; t < 1020.0; t += 0.1 + 1e-20 * static_cast<double>(engine())) {
    const double s = t - 1000.0;
    cubic.times_s.push_back(t);
    cubic.values.push_back(2.0 - s + 0.3 * s * s - 0.01 * s * s * s);
  }
  // Values up to 60, times to 1e-13 s at 1000 s: rounding alone.
  EXPECT_LT(WhiteNoise(cubic), 1e-11);
}

TEST(WhiteNoise, FindsTheSigmaOfNoiseOnAMotionWithJumps) {
  TimeSeries series;
  RandomEngine engine(4);
  boost::random::normal_distribution<double> normal;
  for (int k = 0; k < 4000; ++k) {
    const double t = 0.1 * k;
    series.times_s.push_back(t);
    series.values.push_back(3.0 * std::sin(0.3 * t) + (k % 100 < 50 ? 1.0 : 0.0) +
                            0.02 * normal(engine));
  }
  // The jumps touch 4 of 50 differences and lift the median by a tenth; the estimate scatters by 2
  // %.
  EXPECT_NEAR(WhiteNoise(series), 0.02, 0.003);
}

TEST(WhiteNoise, NeedsFiveSamples) {
  EXPECT_EQ(WhiteNoise({{0.0, 1.0, 2.0, 3.0}, {1.0, -1.0, 1.0, -1.0}}), 0.0);
}

// The noise the dataset states against the noise it has: the same boat measured twice.
TEST(Prepare, StatesTheNoiseLeftInItsVelocities) {
  const auto track = Simulate(YellowfishTwin(), {}, SampleMission(1), 300.0, 0.02);
  SensorOptions noisy;
  noisy.position_noise_m = 0.02;
  noisy.heading_noise_deg = 0.3;
  SensorOptions clean = noisy;
  clean.position_noise_m = 0.0;
  clean.heading_noise_deg = 0.0;
  const Vehicle vehicle = YellowfishVehicle();
  for (const PrepareOptions& options : {PrepareOptions::Robust(), PrepareOptions::Paper()}) {
    const auto with_noise = Prepare(Measure(track, vehicle, noisy), vehicle, options);
    const auto without = Prepare(Measure(track, vehicle, clean), vehicle, options);
    ASSERT_TRUE(with_noise && without);
    ASSERT_EQ(with_noise->rows.size(), without->rows.size());
    for (const auto velocity : {&Nu::u, &Nu::v, &Nu::r}) {
      double squares = 0.0;
      for (std::size_t k = 0; k < with_noise->rows.size(); ++k) {
        squares += std::pow(with_noise->rows[k].nu.*velocity - without->rows[k].nu.*velocity, 2);
      }
      const double actual = std::sqrt(squares / static_cast<double>(with_noise->rows.size()));
      // The scatter of both, what command steps add to one, and the heading's part in u and v.
      EXPECT_NEAR(with_noise->nu_noise.*velocity / actual, 1.0, 0.15);
    }
    EXPECT_LT(without->nu_noise.u, 0.1 * with_noise->nu_noise.u);
  }
}

}  // namespace
}  // namespace telltale
