#include "telltale/core/uncertainty/parametric_bootstrap.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {
namespace {

Recording Noisy() {
  SensorOptions sensors;
  sensors.position_noise_m = 0.04;
  sensors.heading_noise_deg = 0.4;
  return testing::SimulateStableBoat(testing::StableBoat(), 600.0, sensors, 21);
}

Identification With(Resampling resampling, IntervalMethod method, std::size_t threads = 2) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.resampling = resampling;
  options.interval_method = method;
  options.bootstrap_replicates = 200;
  options.threads = threads;
  return Identify(Noisy(), testing::StableBoatVehicle(), options).value();
}

/// How far the middles of the intervals lie from the truth, over the coefficients that two
/// centimetres more or less of noise attenuate most: drag and forward thrust in surge and yaw.
double OffCentre(const Identification& identification) {
  const VesselModel boat = testing::StableBoat();
  double off = 0.0;
  for (const auto& [place, truth] : {std::pair{0, boat.theta[0][0]},
                                     {5, boat.theta[0][5]},
                                     {25, boat.theta[2][3]},
                                     {31, boat.theta[2][9]}}) {
    const Interval& bounds = identification.coefficients[static_cast<std::size_t>(place)].interval;
    off += std::abs((bounds.lower + bounds.upper) / 2.0 - truth);
  }
  return off;
}

// Repeats show the attenuation that redrawn segments cannot, and studentized intervals take it out
// to first order: the bias of the attenuated estimate is not quite that of the truth.
TEST(ParametricBootstrap, TakesOutMostOfTheBiasOfOneStepLeastSquares) {
  const double by_segments = OffCentre(With(Resampling::kSlices, IntervalMethod::kPercentile));
  const double by_repeats = OffCentre(With(Resampling::kParametric, IntervalMethod::kStudentized));
  EXPECT_LT(by_repeats, 0.4 * by_segments);
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
