#include "telltale/core/identification/certify.hpp"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/boats.hpp"

namespace telltale {
namespace {

Recording SailedForCertificate() {
  SensorOptions sensors;
  sensors.position_noise_m = 0.02;
  return testing::SailStableBoat(testing::StableBoat(), 400.0, sensors, 3);
}

IdentifyOptions Certifying(std::size_t repeats) {
  IdentifyOptions options;
  options.twins = 0;
  options.advise = false;
  options.certificate_twins = repeats;
  options.threads = 2;
  return options;
}

Identification Certified(const IdentifyOptions& options) {
  const auto identification =
      Identify(SailedForCertificate(), testing::StableBoatVehicle(), options);
  EXPECT_TRUE(identification.has_value());
  return *identification;
}

/// Weak-form intervals hold, 35 coefficients in 20 repeats; without correction they may be some
/// points short. That one-step intervals do not is what a certificate is there to show.
TEST(Certify, TellsBoundsThatHoldFromThoseThatDoNot) {
  const Identification weak = Certified(Certifying(20));
  ASSERT_TRUE(weak.certificate.has_value());
  const CoverageCertificate& certificate = *weak.certificate;
  EXPECT_EQ(certificate.asked, 20u);
  EXPECT_EQ(certificate.answered, 20u);
  EXPECT_TRUE(certificate.about_published_model);
  EXPECT_EQ(certificate.level, 0.95);
  ASSERT_EQ(certificate.coefficients.size(), weak.coefficients.size());
  EXPECT_GT(certificate.mean_coverage, 0.88);
  EXPECT_EQ(certificate.joint.of, 20u);

  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 0;
  options.certificate_twins = 20;
  const Identification one_step = Certified(options);
  ASSERT_TRUE(one_step.certificate.has_value());
  EXPECT_LT(one_step.certificate->mean_coverage, certificate.mean_coverage - 0.1);
}

/// The mean is over intervals and the tallies are of the same intervals.
TEST(Certify, CountsEveryIntervalOnce) {
  const Identification identification = Certified(Certifying(10));
  ASSERT_TRUE(identification.certificate.has_value());
  const CoverageCertificate& certificate = *identification.certificate;
  Tally all;
  for (const CoefficientCoverage& coverage : certificate.coefficients) {
    EXPECT_EQ(coverage.tally.of, 10u);
    EXPECT_LT(std::abs(coverage.bias), 5.0);
    all.held += coverage.tally.held;
    all.of += coverage.tally.of;
  }
  EXPECT_NEAR(all.Share(), certificate.mean_coverage, 1e-12);
  EXPECT_GT(certificate.mean_coverage_error, 0.0);
}

/// What twins promise of all coefficients together holds where the boat is the truth: of ten
/// ellipsoids of 95 % seven and more, but for one time in a thousand.
TEST(Certify, JudgesTheEllipsoidThatIsPublished) {
  IdentifyOptions options = Certifying(0);
  options.estimator = Estimator::kWeakIv;
  EXPECT_FALSE(Certified(options).joint.has_value());  // nothing sizes it without twins
  options.twins = 20;
  options.certificate_twins = 10;
  const Identification identification = Certified(options);
  ASSERT_TRUE(identification.joint.has_value());
  EXPECT_GT(identification.joint->covariance_factor, 0.0);
  EXPECT_EQ(identification.joint->degrees_of_freedom,
            static_cast<double>(identification.provenance.clusters) - 1.0);
  EXPECT_NEAR(*SquaredRadius(identification),
              SquaredRadius(*identification.joint, identification.coefficients.size(), 0.95), 1e-9);
  ASSERT_TRUE(identification.certificate.has_value());
  EXPECT_EQ(identification.certificate->joint.of, 10u);
  EXPECT_GE(identification.certificate->joint.held, 7u);
}

TEST(Certify, DoesNotDependOnThreads) {
  IdentifyOptions options = Certifying(10);
  const Identification two = Certified(options);
  options.threads = 1;
  const Identification one = Certified(options);
  ASSERT_TRUE(one.certificate && two.certificate);
  EXPECT_EQ(one.certificate->mean_coverage, two.certificate->mean_coverage);
  EXPECT_EQ(one.certificate->joint, two.certificate->joint);
  for (std::size_t i = 0; i < one.certificate->coefficients.size(); ++i) {
    EXPECT_EQ(one.certificate->coefficients[i].tally, two.certificate->coefficients[i].tally);
    EXPECT_EQ(one.certificate->coefficients[i].bias, two.certificate->coefficients[i].bias);
  }
  options.seed = 2;
  EXPECT_NE(Certified(options).certificate->coefficients[0].bias,
            one.certificate->coefficients[0].bias);
}

TEST(Certify, ReportsProgressThatOnlyRises) {
  std::vector<double> told;
  const auto result =
      Identify(SailedForCertificate(), testing::StableBoatVehicle(), Certifying(10),
               [&](std::string_view, double fraction) { told.push_back(fraction); });
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_NEAR(told.back(), 1.0, 1e-9);
  EXPECT_GT(told.size(), 20u);
}

TEST(Certify, IsBrokenOffByWhoeverListens) {
  const auto stop_half_way = [](std::string_view, double fraction) {
    if (fraction > 0.5) throw std::runtime_error("stop");
  };
  EXPECT_THROW(
      Identify(SailedForCertificate(), testing::StableBoatVehicle(), Certifying(10), stop_half_way)
          .has_value(),
      std::runtime_error);
}

TEST(Certify, RefusesANumberOutOfRange) {
  for (const std::size_t repeats : {1u, 9u, 1001u}) {
    const auto result =
        Identify(SailedForCertificate(), testing::StableBoatVehicle(), Certifying(repeats));
    ASSERT_FALSE(result.has_value());
    EXPECT_NE(result.error().reason.find("certificate_twins"), std::string::npos);
    EXPECT_NE(result.error().reason.find("[10, 1000]"), std::string::npos);
  }
}

/// Straight runs answer surge alone: sway and yaw go as measured, and surge is certified.
TEST(Certify, CertifiesTheEquationsThereAre) {
  SensorOptions sensors;
  const auto commands = Schedule({Repeated(SurgeSteps(0.2, 0.9, 1, 4.0), 300.0)}, 0.0);
  const Recording straight = Measure(Simulate(testing::StableBoat(), {}, commands, 300.0, 0.02),
                                     testing::StableBoatVehicle(), sensors);
  const auto result = Identify(straight, testing::StableBoatVehicle(), Certifying(10));
  ASSERT_TRUE(result.has_value()) << result.error().reason;
  EXPECT_FALSE(result->Has(Equation::kYaw));
  EXPECT_TRUE(std::none_of(result->refusals.begin(), result->refusals.end(), [](const auto& r) {
    return r.subject == "certificate";
  })) << result->refusals.back().reason;
  ASSERT_TRUE(result->certificate.has_value());
  EXPECT_EQ(result->certificate->coefficients.size(), result->coefficients.size());
  EXPECT_GE(result->certificate->answered, 8u);
}

TEST(Certify, TheTimeConstantIsCertifiedToo) {
  VesselModel lagging = testing::StableBoat();
  lagging.structure = Structure::kFirstOrderDynamic;
  lagging.thruster_time_constant_s = 0.5;
  IdentifyOptions options = Certifying(10);
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto result = Identify(testing::SailStableBoat(lagging, 300.0, {}, 3),
                               testing::StableBoatVehicle(), options);
  ASSERT_TRUE(result.has_value());
  ASSERT_TRUE(result->certificate.has_value());
  ASSERT_TRUE(result->certificate->thruster_time_constant.has_value());
  EXPECT_GE(result->certificate->thruster_time_constant->tally.of, 9u);
}

}  // namespace
}  // namespace telltale
