#include "identification/simulated_replicates.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "identification/identify.hpp"
#include "support/boats.hpp"

namespace telltale {
namespace {

Recording Noisy() {
  SensorOptions sensors;
  sensors.position_noise_m = 0.04;
  sensors.heading_noise_deg = 0.4;
  return testing::SailStableBoat(testing::StableBoat(), 600.0, sensors, 21);
}

Identification With(Resampling resampling, IntervalMethod method, std::size_t threads = 2) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.resampling = resampling;
  options.interval_method = method;
  options.bootstrap_replicates = 200;
  options.threads = threads;
  return Identify(Noisy(), testing::StableBoatVehicle(), options).value();
}

std::size_t Held(const Identification& identification) {
  const VesselModel boat = testing::StableBoat();
  std::size_t held = 0;
  std::size_t i = 0;
  for (const Eigen::VectorXd& theta : boat.theta) {
    for (const double truth : theta) {
      const Interval& bounds = identification.coefficients[i++].interval;
      held += truth >= bounds.lower && truth <= bounds.upper ? 1 : 0;
    }
  }
  return held;
}

// Repeats show the attenuation that redrawn segments cannot, and BCa takes it out.
TEST(ParametricBootstrap, SeesTheBiasOfOneStepLeastSquares) {
  const std::size_t by_segments = Held(With(Resampling::kSegments, IntervalMethod::kPercentile));
  const std::size_t by_repeats = Held(With(Resampling::kParametric, IntervalMethod::kBca));
  EXPECT_GE(by_repeats, by_segments + 3) << "of 35";
}

TEST(ParametricBootstrap, SaysWhatItIs) {
  const Identification found = With(Resampling::kParametric, IntervalMethod::kStudentized);
  EXPECT_NE(found.provenance.bounds_basis.find("parametric bootstrap"), std::string::npos);
  EXPECT_TRUE(found.disturbance);
  for (const Coefficient& c : found.coefficients) {
    EXPECT_LT(c.interval.lower, c.interval.upper);
    EXPECT_TRUE(std::isfinite(c.standard_error));
  }
}

TEST(ParametricBootstrap, DoesNotDependOnThreads) {
  const Identification one = With(Resampling::kParametric, IntervalMethod::kPercentile, 1);
  const Identification two = With(Resampling::kParametric, IntervalMethod::kPercentile, 2);
  EXPECT_EQ(one.covariance, two.covariance);
}

TEST(ParametricBootstrap, NeedsTheRobustPreset) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.resampling = Resampling::kParametric;
  EXPECT_FALSE(options.Validate());
  options.prepare = PrepareOptions::Paper();
  ASSERT_TRUE(options.Validate());
  EXPECT_EQ(options.Validate()->subject, "resampling");
}

}  // namespace
}  // namespace telltale
