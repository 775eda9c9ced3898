#include "telltale/core/identification/output_error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/reference_boat.hpp"
#include "support/stable_boat.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kTenMinutes = 15;  // in segments

IdentifyOptions ByOutputError() {
  IdentifyOptions options;
  options.estimator = Estimator::kOutputError;
  return options;
}

/// 35 coefficients, five standard errors each: never.
void ExpectAllNear(const Identification& result, const std::vector<double>& truth) {
  ASSERT_EQ(result.coefficients.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Coefficient& c = result.coefficients[i];
    EXPECT_EQ(c.status, CoefficientStatus::kEstimated) << c.symbol;
    EXPECT_GT(c.standard_error, 0.0) << c.symbol;
    EXPECT_NEAR(c.estimate, truth[i], 5.0 * c.standard_error) << c.symbol;
    EXPECT_LT(c.interval.lower, c.estimate) << c.symbol;
    EXPECT_GT(c.interval.upper, c.estimate) << c.symbol;
  }
}

const Coefficient& Find(const Identification& result, Equation equation,
                        const std::string& regressor) {
  return *std::find_if(
      result.coefficients.begin(), result.coefficients.end(),
      [&](const Coefficient& c) { return c.equation == equation && c.regressor == regressor; });
}

TEST(OutputErrorEstimate, BoundsTheBoatWithoutDisturbance) {
  const auto result = Identify(testing::SimulateReferenceBoat(0.0, kTenMinutes, 1),
                               coverage::VehicleOf(), ByOutputError());
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->estimator, Estimator::kOutputError);
  ExpectAllNear(*result, coverage::CoefficientsOf(coverage::ReferenceBoat()));
  EXPECT_LT(result->provenance.misspecification, kLargestAcceptedMisspecification);
  EXPECT_GT(result->provenance.misspecification, 0.7);
  EXPECT_THAT(result->provenance.bounds_basis, HasSubstr("misspecification ratio"));
  EXPECT_EQ(result->provenance.estimator_choice, "");  // it was named
  EXPECT_EQ(result->provenance.parametric_replicates, 0U);
  EXPECT_TRUE(result->refusals.empty());
  // Hotelling: F(35, g - 35) times 35 (g - 1) / (g - 35), g clusters.
  ASSERT_TRUE(result->joint.has_value());
  const auto clusters = static_cast<double>(result->provenance.clusters);
  EXPECT_DOUBLE_EQ(result->joint->covariance_factor, (clusters - 1.0) / (clusters - 35.0));
  EXPECT_DOUBLE_EQ(result->joint->degrees_of_freedom, clusters - 1.0);
  EXPECT_TRUE(ModelOf(*result)->discretisation == Discretisation::kContinuous);
}

TEST(OutputErrorEstimate, BoundsTheThrustersLag) {
  coverage::Boat boat = coverage::ReferenceBoat();
  boat.thruster_time_constant_s = 0.4;
  IdentifyOptions options = ByOutputError();
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto result = Identify(testing::SimulateReferenceBoat(0.0, kTenMinutes, 2, boat),
                               coverage::VehicleOf(), options);
  ASSERT_TRUE(result.has_value());
  ExpectAllNear(*result, coverage::CoefficientsOf(boat));
  ASSERT_TRUE(result->thruster_time_constant.has_value());
  const Coefficient& tau = *result->thruster_time_constant;
  EXPECT_NEAR(tau.estimate, 0.4, 5.0 * tau.standard_error);
  EXPECT_EQ(tau.status, CoefficientStatus::kEstimated);
  EXPECT_EQ(result->time_constant_covariance.size(), 35);
}

TEST(OutputErrorEstimate, SaysThatItsBoundsDoNotHoldUnderDisturbances) {
  const auto result = Identify(testing::SimulateReferenceBoat(1.0, kTenMinutes, 3),
                               coverage::VehicleOf(), ByOutputError());
  ASSERT_TRUE(result.has_value());
  EXPECT_GT(result->provenance.misspecification, 2.0);
  EXPECT_THAT(result->provenance.bounds_basis, HasSubstr("bias is left"));
  EXPECT_THAT(result->refusals,
              Contains(Field(&Refusal::reason, HasSubstr("hold less often than they say"))));
}

/// Full ahead or nothing: delta and its square are one number.
TEST(OutputErrorEstimate, NamesThrustTermsThatAreCollinearUnderOneCommand) {
  constexpr double kCommand = 0.6;
  std::vector<TimedCommand> commands = testing::VariedCommands(400.0, 5);
  for (TimedCommand& command : commands) {
    command.delta.port = command.delta.port > 0.4 ? kCommand : 0.0;
    command.delta.starboard = command.delta.starboard > 0.4 ? kCommand : 0.0;
  }
  VesselState start;
  start.nu.u = 0.5;
  const Recording recording = Measure(Simulate(testing::StableBoat(), start, commands, 400.0, 0.02),
                                      testing::StableBoatVehicle(), SensorOptions{});
  const auto result = Identify(recording, testing::StableBoatVehicle(), ByOutputError());
  ASSERT_TRUE(result.has_value());
  for (const Equation equation : kEquations) {
    for (const char* regressor : {"f:d^2", "f:d"}) {
      const Coefficient& c = Find(*result, equation, regressor);
      EXPECT_EQ(c.status, CoefficientStatus::kCollinear) << c.symbol;
      EXPECT_TRUE(std::isinf(c.standard_error)) << c.symbol;
      EXPECT_TRUE(std::isfinite(c.estimate)) << c.symbol;
    }
    for (const char* regressor : {"r:d^2", "r:d"}) {
      const Coefficient& c = Find(*result, equation, regressor);
      EXPECT_EQ(c.status, CoefficientStatus::kNotExcited) << c.symbol;
      EXPECT_EQ(c.estimate, 0.0) << c.symbol;
    }
    // The separable coefficients are bounded.
    const double sum = kCommand * kCommand * Find(*result, equation, "f:d^2").estimate +
                       kCommand * Find(*result, equation, "f:d").estimate;
    const Eigen::VectorXd truth = testing::StableBoat().theta[IndexOf(equation)];
    const Eigen::Index at = equation == Equation::kSurge ? 5 : 9;
    EXPECT_NEAR(sum, kCommand * kCommand * truth[at] + kCommand * truth[at + 1], 0.02);
  }
  EXPECT_THAT(result->refusals, Contains(Field(&Refusal::subject, HasSubstr("SURGE f:d"))));
  EXPECT_THAT(result->refusals, Contains(Field(&Refusal::reason, HasSubstr("collinear"))));
}

TEST(OutputErrorEstimate, RefusesWithoutAllThreeEquations) {
  std::vector<TimedCommand> commands = testing::VariedCommands(300.0, 6);
  for (TimedCommand& command : commands) command.delta.starboard = command.delta.port;
  const Recording recording = Measure(Simulate(testing::StableBoat(), {}, commands, 300.0, 0.02),
                                      testing::StableBoatVehicle(), SensorOptions{});
  const auto result = Identify(recording, testing::StableBoatVehicle(), ByOutputError());
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().subject, "output error");
  EXPECT_THAT(result.error().reason, HasSubstr("SWAY"));
  EXPECT_THAT(result.error().advice, HasSubstr("weak-iv"));
}

}  // namespace
}  // namespace telltale
