#include "telltale/core/identification/coverage_check.hpp"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"

namespace telltale {
namespace {

Recording SimulatedForCoverageCheck() {
  SensorOptions sensors;
  sensors.position_noise_m = 0.02;
  return testing::SimulateStableBoat(testing::StableBoat(), 400.0, sensors, 3);
}

IdentifyOptions CheckingCoverage(std::size_t repeats) {
  IdentifyOptions options;
  options.parametric_replicates = 0;
  options.advise = false;
  options.coverage_check_replicates = repeats;
  options.threads = 2;
  return options;
}

Identification WithCoverageCheck(const IdentifyOptions& options) {
  const auto identification =
      Identify(SimulatedForCoverageCheck(), testing::StableBoatVehicle(), options);
  EXPECT_TRUE(identification.has_value());
  return *identification;
}

/// Weak-form intervals hold, 35 coefficients in 20 repeats; without correction they may be some
/// points short. The coverage check shows that one-step intervals do not.
TEST(CheckCoverage, TellsBoundsThatHoldFromThoseThatDoNot) {
  const Identification weak = WithCoverageCheck(CheckingCoverage(20));
  ASSERT_TRUE(weak.coverage_check.has_value());
  const CoverageCheck& coverage_check = *weak.coverage_check;
  EXPECT_EQ(coverage_check.replicates_requested, 20u);
  EXPECT_EQ(coverage_check.replicates_identified, 20u);
  EXPECT_TRUE(coverage_check.truth_is_reported_model);
  EXPECT_EQ(coverage_check.level, 0.95);
  ASSERT_EQ(coverage_check.coefficients.size(), weak.coefficients.size());
  EXPECT_GT(coverage_check.mean_coverage, 0.88);
  EXPECT_EQ(coverage_check.joint.of, 20u);

  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 0;
  options.coverage_check_replicates = 20;
  const Identification one_step = WithCoverageCheck(options);
  ASSERT_TRUE(one_step.coverage_check.has_value());
  EXPECT_LT(one_step.coverage_check->mean_coverage, coverage_check.mean_coverage - 0.1);
}

/// The mean is over intervals and the tallies are of the same intervals.
TEST(CheckCoverage, CountsEveryIntervalOnce) {
  const Identification identification = WithCoverageCheck(CheckingCoverage(10));
  ASSERT_TRUE(identification.coverage_check.has_value());
  const CoverageCheck& coverage_check = *identification.coverage_check;
  Tally all;
  for (const CoefficientCoverage& coverage : coverage_check.coefficients) {
    EXPECT_EQ(coverage.tally.of, 10u);
    EXPECT_LT(std::abs(coverage.bias), 5.0);
    all.held += coverage.tally.held;
    all.of += coverage.tally.of;
  }
  EXPECT_NEAR(all.Share(), coverage_check.mean_coverage, 1e-12);
  EXPECT_GT(coverage_check.mean_coverage_error, 0.0);
}

/// What replicates promise of all coefficients together holds where the boat is the truth: of ten
/// ellipsoids of 95 % seven and more, but for one time in a thousand.
TEST(CheckCoverage, ChecksTheEllipsoidThatIsReported) {
  IdentifyOptions options = CheckingCoverage(0);
  options.estimator = Estimator::kWeakIv;
  EXPECT_FALSE(
      WithCoverageCheck(options).joint.has_value());  // nothing sizes it without replicates
  options.parametric_replicates = 20;
  options.coverage_check_replicates = 10;
  const Identification identification = WithCoverageCheck(options);
  ASSERT_TRUE(identification.joint.has_value());
  EXPECT_GT(identification.joint->covariance_factor, 0.0);
  EXPECT_EQ(identification.joint->degrees_of_freedom,
            static_cast<double>(identification.provenance.clusters) - 1.0);
  EXPECT_NEAR(*SquaredRadius(identification),
              SquaredRadius(*identification.joint, identification.coefficients.size(), 0.95), 1e-9);
  ASSERT_TRUE(identification.coverage_check.has_value());
  EXPECT_EQ(identification.coverage_check->joint.of, 10u);
  EXPECT_GE(identification.coverage_check->joint.held, 7u);
}

TEST(CheckCoverage, DoesNotDependOnThreads) {
  IdentifyOptions options = CheckingCoverage(10);
  const Identification two = WithCoverageCheck(options);
  options.threads = 1;
  const Identification one = WithCoverageCheck(options);
  ASSERT_TRUE(one.coverage_check && two.coverage_check);
  EXPECT_EQ(one.coverage_check->mean_coverage, two.coverage_check->mean_coverage);
  EXPECT_EQ(one.coverage_check->joint, two.coverage_check->joint);
  for (std::size_t i = 0; i < one.coverage_check->coefficients.size(); ++i) {
    EXPECT_EQ(one.coverage_check->coefficients[i].tally, two.coverage_check->coefficients[i].tally);
    EXPECT_EQ(one.coverage_check->coefficients[i].bias, two.coverage_check->coefficients[i].bias);
  }
  options.seed = 2;
  EXPECT_NE(WithCoverageCheck(options).coverage_check->coefficients[0].bias,
            one.coverage_check->coefficients[0].bias);
}

TEST(CheckCoverage, ReportsProgressThatOnlyRises) {
  std::vector<double> told;
  const auto result =
      Identify(SimulatedForCoverageCheck(), testing::StableBoatVehicle(), CheckingCoverage(10),
               [&](std::string_view, double fraction) { told.push_back(fraction); });
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_NEAR(told.back(), 1.0, 1e-9);
  EXPECT_GT(told.size(), 20u);
}

TEST(CheckCoverage, IsBrokenOffByWhoeverListens) {
  const auto stop_half_way = [](std::string_view, double fraction) {
    if (fraction > 0.5) throw std::runtime_error("stop");
  };
  EXPECT_THROW(Identify(SimulatedForCoverageCheck(), testing::StableBoatVehicle(),
                        CheckingCoverage(10), stop_half_way)
                   .has_value(),
               std::runtime_error);
}

TEST(CheckCoverage, RefusesANumberOutOfRange) {
  for (const std::size_t repeats : {1u, 9u, 1001u}) {
    const auto result = Identify(SimulatedForCoverageCheck(), testing::StableBoatVehicle(),
                                 CheckingCoverage(repeats));
    ASSERT_FALSE(result.has_value());
    EXPECT_NE(result.error().reason.find("coverage_check_replicates"), std::string::npos);
    EXPECT_NE(result.error().reason.find("[10, 1000]"), std::string::npos);
  }
}

/// Straight runs answer surge alone: sway and yaw go as measured, and the coverage of surge is
/// checked.
TEST(CheckCoverage, ChecksTheEquationsThereAre) {
  SensorOptions sensors;
  const auto commands = Schedule({Repeated(SurgeSteps(0.2, 0.9, 1, 4.0), 300.0)}, 0.0);
  const Recording straight = Measure(Simulate(testing::StableBoat(), {}, commands, 300.0, 0.02),
                                     testing::StableBoatVehicle(), sensors);
  const auto result = Identify(straight, testing::StableBoatVehicle(), CheckingCoverage(10));
  ASSERT_TRUE(result.has_value()) << result.error().reason;
  EXPECT_FALSE(result->Has(Equation::kYaw));
  EXPECT_TRUE(std::none_of(result->refusals.begin(), result->refusals.end(), [](const auto& r) {
    return r.subject == "coverage_check";
  })) << result->refusals.back().reason;
  ASSERT_TRUE(result->coverage_check.has_value());
  EXPECT_EQ(result->coverage_check->coefficients.size(), result->coefficients.size());
  EXPECT_GE(result->coverage_check->replicates_identified, 8u);
}

TEST(CheckCoverage, TheTimeConstantIsCheckedToo) {
  VesselModel lagging = testing::StableBoat();
  lagging.structure = Structure::kFirstOrderDynamic;
  lagging.thruster_time_constant_s = 0.5;
  IdentifyOptions options = CheckingCoverage(10);
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto result = Identify(testing::SimulateStableBoat(lagging, 300.0, {}, 3),
                               testing::StableBoatVehicle(), options);
  ASSERT_TRUE(result.has_value());
  ASSERT_TRUE(result->coverage_check.has_value());
  ASSERT_TRUE(result->coverage_check->thruster_time_constant.has_value());
  EXPECT_GE(result->coverage_check->thruster_time_constant->tally.of, 9u);
}

}  // namespace
}  // namespace telltale
