#include "telltale/core/identification/identify.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "support/stable_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

constexpr auto kFF = PropellerRegion::kFF;
constexpr auto kFR = PropellerRegion::kFR;
constexpr auto kRF = PropellerRegion::kRF;

PreparedDataset DatasetOf(const std::vector<PropellerRegion>& regions, double noise_mps = 0.0) {
  PreparedDataset dataset =
      testing::DriveDiscrete(YellowfishTwin(), testing::RandomCommands(3000, regions, 7), 50);
  RandomEngine engine(1);
  boost::random::normal_distribution<double> noise(0.0, 1.0);
  for (PreparedRow& row : dataset.rows) {
    row.nu.u += noise_mps * noise(engine);
    row.nu.v += noise_mps * noise(engine);
    row.nu.r += noise_mps * noise(engine);
  }
  return dataset;
}

IdentifyOptions Quick() {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 200;
  return options;
}

bool Refuses(const Identification& identification, const std::string& subject) {
  return std::any_of(identification.refusals.begin(), identification.refusals.end(),
                     [&](const Refusal& r) { return r.subject == subject; });
}

TEST(Identify, WritesEveryCoefficientInOrderWithBounds) {
  const auto result = Identify(DatasetOf({kFF, kFR, kRF}, 1e-4), "boat", Quick());
  ASSERT_TRUE(result.has_value());
  const std::size_t expected = 9 + 13 + 13;
  ASSERT_EQ(result->coefficients.size(), expected);
  EXPECT_FALSE(Refuses(*result, "free run"));  // the boat's own model stays with the boat
  EXPECT_EQ(result->covariance.rows(), static_cast<Eigen::Index>(expected));
  EXPECT_TRUE(result->covariance.isApprox(result->covariance.transpose()));
  std::size_t next = 0;
  for (const Equation equation : kEquations) {
    for (const Regressor& regressor : Regressors(equation, Parameterization::kPropeller)) {
      const Coefficient& c = result->coefficients[next];
      EXPECT_EQ(c.equation, equation);
      EXPECT_EQ(c.regressor, regressor.name);
      EXPECT_EQ(c.status, CoefficientStatus::kEstimated) << c.regressor;
      EXPECT_LE(c.interval.lower, c.estimate);
      EXPECT_GE(c.interval.upper, c.estimate);
      const auto place = static_cast<Eigen::Index>(next);
      EXPECT_DOUBLE_EQ(c.standard_error, std::sqrt(result->covariance(place, place)));
      ++next;
    }
  }
}

/// Known truth: noise of 1e-4 m/s on velocities 0.2 s apart leaves the thrust coefficients right.
TEST(Identify, RecoversTheSimulatedBoat) {
  const VesselModel truth = YellowfishTwin();
  const auto result = Identify(DatasetOf({kFF, kFR, kRF}, 1e-4), "boat", Quick());
  ASSERT_TRUE(result.has_value());
  for (const Coefficient& c : result->coefficients) {
    if (c.regressor != "f:d") continue;
    const Eigen::VectorXd& theta = truth.theta[IndexOf(c.equation)];
    const double expected = theta[theta.size() - 3];
    EXPECT_NEAR(c.estimate, expected, 0.02 * std::abs(expected)) << Name(c.equation);
  }
}

TEST(Identify, RefusesSwayAndYawOfAStraightRunAndAnswersSurge) {
  PreparedDataset dataset = DatasetOf({kFF});
  for (PreparedRow& row : dataset.rows) {
    row.delta.starboard = row.delta.port;
    row.nu.v = 0.0;
    row.nu.r = 0.0;
  }
  for (std::size_t k = 0; k + 1 < dataset.rows.size(); ++k) {
    const NuDot nu_dot = YellowfishTwin().Acceleration(dataset.rows[k].nu, dataset.rows[k].delta);
    dataset.rows[k + 1].nu.u = dataset.rows[k].nu.u + 0.2 * nu_dot.u;
  }
  const auto result = Identify(dataset, "boat", Quick());
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(result->Has(Equation::kSurge));
  EXPECT_FALSE(result->Has(Equation::kSway));
  EXPECT_FALSE(result->Has(Equation::kYaw));
  EXPECT_TRUE(Refuses(*result, "SWAY"));
  EXPECT_TRUE(Refuses(*result, "YAW"));
  for (const Refusal& refusal : result->refusals) {
    EXPECT_FALSE(refusal.reason.empty());
    EXPECT_FALSE(refusal.advice.empty());
  }
  EXPECT_FALSE(ModelOf(*result).has_value());
}

/// A propeller that never reversed: its reverse coefficients are unknown and say so.
TEST(Identify, MarksUnmovedPropellersAsNotExcited) {
  const auto result = Identify(DatasetOf({kFF}, 1e-3), "boat", Quick());
  ASSERT_TRUE(result.has_value());
  for (const Coefficient& c : result->coefficients) {
    const bool reverse = c.regressor.starts_with("r:");
    EXPECT_EQ(c.status == CoefficientStatus::kNotExcited, reverse) << c.regressor;
    if (!reverse) continue;
    EXPECT_EQ(c.estimate, 0.0);
    EXPECT_TRUE(std::isinf(c.standard_error));
    EXPECT_TRUE(std::isinf(c.interval.lower) && std::isinf(c.interval.upper));
  }
}

TEST(Identify, RefusesABoatThatNeverMoved) {
  PreparedDataset dataset = DatasetOf({kFF});
  for (PreparedRow& row : dataset.rows) {
    row.nu = {};
    row.delta = {};
  }
  const auto result = Identify(dataset, "boat", Quick());
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().subject, "model");
  EXPECT_NE(result.error().reason.find("SURGE"), std::string::npos);
}

TEST(Identify, RefusesTooShortARecording) {
  PreparedDataset dataset = DatasetOf({kFF, kFR, kRF});
  dataset.rows.resize(60);
  dataset.segments = {{0, 60}};
  dataset.slices = {{0, 60}};
  const auto result = Identify(dataset, "boat", Quick());
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().reason.find("usable rows"), std::string::npos);
}

TEST(Identify, WithoutBootstrapBoundsRestOnResiduals) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 0;
  const auto result = Identify(DatasetOf({kFF, kFR, kRF}, 1e-3), "boat", options);
  ASSERT_TRUE(result.has_value());
  EXPECT_NE(result->provenance.bounds_basis.find("residual"), std::string::npos);
  for (const Coefficient& c : result->coefficients) EXPECT_GT(c.standard_error, 0.0);
}

/// Errors are white here, so every way of drawing and bounding answers the same question; among 35
/// coefficients and 200 replicates the mean ratio of two standard errors is good to 10 %.
TEST(Identify, BoundsByBlocksAndEachMethodAgreeOnWhiteErrors) {
  const PreparedDataset boat = DatasetOf({kFF, kFR, kRF}, 1e-4);
  const auto slices = Identify(boat, "boat", Quick());
  for (const IntervalMethod method :
       {IntervalMethod::kPercentile, IntervalMethod::kStudentized, IntervalMethod::kBca}) {
    IdentifyOptions options = Quick();
    options.resampling = Resampling::kMovingBlocks;
    options.interval_method = method;
    const auto blocks = Identify(boat, "boat", options);
    ASSERT_TRUE(blocks.has_value());
    EXPECT_NE(blocks->provenance.bounds_basis.find("moving-block bootstrap, blocks of "),
              std::string::npos);
    double errors = 0.0;
    double widths = 0.0;
    for (std::size_t i = 0; i < blocks->coefficients.size(); ++i) {
      const Coefficient& c = blocks->coefficients[i];
      const Coefficient& other = slices->coefficients[i];
      EXPECT_EQ(c.estimate, other.estimate);
      EXPECT_LT(c.interval.lower, c.interval.upper);
      errors += std::log(c.standard_error / other.standard_error) / 35.0;
      widths += std::log((c.interval.upper - c.interval.lower) / (3.92 * c.standard_error)) / 35.0;
    }
    EXPECT_NEAR(errors, 0.0, 0.1) << Name(method);
    EXPECT_NEAR(widths, 0.0, 0.15) << Name(method);
  }
}

/// The joint fit's rows are stacked; blocks must take all equations of an instant.
TEST(Identify, BoundsTheDynamicStructureByBlocks) {
  IdentifyOptions options = Quick();
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto slices = Identify(DatasetOf({kFF, kFR, kRF}, 1e-4), "boat", options);
  options.resampling = Resampling::kMovingBlocks;
  const auto blocks = Identify(DatasetOf({kFF, kFR, kRF}, 1e-4), "boat", options);
  ASSERT_TRUE(slices.has_value() && blocks.has_value());
  double errors = 0.0;
  for (std::size_t i = 0; i < 35; ++i) {
    errors +=
        std::log(blocks->coefficients[i].standard_error / slices->coefficients[i].standard_error) /
        35.0;
  }
  EXPECT_NEAR(errors, 0.0, 0.1);
}

TEST(Identify, WarnsWhenBoundsRestOnFewSegments) {
  PreparedDataset dataset = DatasetOf({kFF, kFR, kRF}, 1e-3);
  dataset.slices = {{0, 1000}, {1000, 2000}, {2000, 3000}};
  const auto result = Identify(dataset, "boat", Quick());
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(Refuses(*result, "bounds"));
}

/// Lagging thrusters: one time constant with bounds around the truth, and a model that can be
/// simulated.
TEST(Identify, AnswersTheDynamicStructure) {
  VesselModel truth = YellowfishTwin();
  truth.structure = Structure::kFirstOrderDynamic;
  truth.discretisation = Discretisation::kForwardEuler;
  truth.thruster_time_constant_s = 0.5;
  PreparedDataset dataset = DatasetOf({kFF, kFR, kRF});
  VesselState state;
  RandomEngine engine(1);
  boost::random::normal_distribution<double> noise(0.0, 1e-5);
  for (PreparedRow& row : dataset.rows) {
    row.nu = {state.nu.u + noise(engine), state.nu.v + noise(engine), state.nu.r + noise(engine)};
    state = Advance(truth, state, row.delta, truth.sampling_period_s);
  }
  IdentifyOptions options = Quick();
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto result = Identify(dataset, "boat", options);
  ASSERT_TRUE(result.has_value());
  ASSERT_TRUE(result->thruster_time_constant.has_value());
  const Coefficient& tau = *result->thruster_time_constant;
  EXPECT_NEAR(tau.estimate, 0.5, 0.01);
  EXPECT_GT(tau.standard_error, 0.0);
  EXPECT_LE(tau.interval.lower, tau.estimate);
  EXPECT_GE(tau.interval.upper, tau.estimate);
  EXPECT_EQ(result->coefficients.size(), 35u);
  EXPECT_EQ(result->covariance.rows(), 35);
  const auto model = ModelOf(*result);
  ASSERT_TRUE(model.has_value());
  EXPECT_EQ(model->structure, Structure::kFirstOrderDynamic);
  EXPECT_DOUBLE_EQ(*model->thruster_time_constant_s, tau.estimate);
}

/// The same boat pushed about at random many times: estimates of lag and coefficients scatter
/// together as the reported covariance says. Pushes enter the equation as white errors of y, which
/// is what residual bounds assume. 100 boats hold a correlation to 0.1 at one sigma.
TEST(Identify, KnowsHowLagAndCoefficientsErrTogether) {
  VesselModel truth = YellowfishTwin();
  truth.structure = Structure::kFirstOrderDynamic;
  truth.discretisation = Discretisation::kForwardEuler;
  truth.thruster_time_constant_s = 0.5;
  PreparedDataset dataset =
      testing::DriveDiscrete(truth, testing::RandomCommands(600, {kFF, kFR, kRF}, 7), 50);
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 0;
  options.regression.structure = Structure::kFirstOrderDynamic;
  constexpr Eigen::Index kBoats = 100;
  Eigen::MatrixXd theta(35, kBoats);
  Eigen::VectorXd tau(kBoats);
  Eigen::VectorXd reported = Eigen::VectorXd::Zero(35);
  for (Eigen::Index boat = 0; boat < kBoats; ++boat) {
    RandomEngine engine = RandomEngine::Stream(3, static_cast<std::size_t>(boat));
    boost::random::normal_distribution<double> push(0.0, 1e-3);
    VesselState state;
    for (PreparedRow& row : dataset.rows) {
      row.nu = state.nu;
      state = Advance(truth, state, row.delta, truth.sampling_period_s);
      state.nu = {state.nu.u + push(engine), state.nu.v + push(engine), state.nu.r + push(engine)};
    }
    const auto result = Identify(dataset, "boat", options);
    ASSERT_TRUE(result.has_value());
    tau[boat] = result->thruster_time_constant->estimate;
    for (Eigen::Index i = 0; i < 35; ++i) {
      const Coefficient& c = result->coefficients[static_cast<std::size_t>(i)];
      theta(i, boat) = c.estimate;
      reported[i] += result->time_constant_covariance[i] /
                     (c.standard_error * result->thruster_time_constant->standard_error) / kBoats;
    }
  }
  const Eigen::VectorXd tau_apart = tau.array() - tau.mean();
  for (Eigen::Index i = 0; i < 35; ++i) {
    const Eigen::VectorXd row = theta.row(i);
    const Eigen::VectorXd apart = row.array() - row.mean();
    EXPECT_NEAR(apart.dot(tau_apart) / (apart.norm() * tau_apart.norm()), reported[i], 0.35) << i;
  }
  EXPECT_GT(reported.cwiseAbs().maxCoeff(), 0.5);  // far from what none would report
}

TEST(Identify, LeavesNoCovarianceWithWhatTheDataNeverMoved) {
  IdentifyOptions options = Quick();
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto result = Identify(DatasetOf({kFF}, 1e-3), "boat", options);
  ASSERT_TRUE(result.has_value());
  ASSERT_EQ(result->time_constant_covariance.size(), 35);
  for (std::size_t i = 0; i < 35; ++i) {
    const bool unmoved = result->coefficients[i].status == CoefficientStatus::kNotExcited;
    EXPECT_EQ(result->time_constant_covariance[static_cast<Eigen::Index>(i)] == 0.0, unmoved) << i;
  }
  options.regression.structure = Structure::kStaticQuadratic;
  EXPECT_EQ(Identify(DatasetOf({kFF}, 1e-3), "boat", options)->time_constant_covariance.size(), 0);
}

/// A boat without lag: the bound from above is what its standard error says, not the end of the
/// range.
TEST(Identify, BoundsALagThatIsNotThereFromAbove) {
  IdentifyOptions options = Quick();
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto result = Identify(DatasetOf({kFF, kFR, kRF}, 1e-3), "boat", options);
  ASSERT_TRUE(result.has_value());
  const Coefficient& tau = *result->thruster_time_constant;
  EXPECT_EQ(tau.interval.lower, 0.0);
  EXPECT_GT(tau.interval.upper, tau.estimate + tau.standard_error);
}

TEST(EstimateModel, IsTheIdentifiedModelWithoutItsBounds) {
  const PreparedDataset dataset = DatasetOf({kFF}, 1e-3);  // reverse is not excited
  for (const auto structure : {Structure::kStaticQuadratic, Structure::kFirstOrderDynamic}) {
    IdentifyOptions options = IdentifyOptions::OneStep();
    options.bootstrap_replicates = 0;
    options.regression.structure = structure;
    options.regression.dead_zone = {0.02, -0.03};
    const auto identified = ModelOf(*Identify(dataset, "boat", options));
    const auto estimated = EstimateModel(dataset, options.regression);
    ASSERT_TRUE(identified.has_value() && estimated.has_value());
    EXPECT_EQ(estimated->theta, identified->theta);
    EXPECT_EQ(estimated->structure, identified->structure);
    EXPECT_EQ(estimated->parameterization, identified->parameterization);
    EXPECT_EQ(estimated->discretisation, identified->discretisation);
    EXPECT_EQ(estimated->sampling_period_s, identified->sampling_period_s);
    EXPECT_EQ(estimated->dead_zone, identified->dead_zone);
    EXPECT_EQ(estimated->thruster_time_constant_s, identified->thruster_time_constant_s);
  }
}

TEST(EstimateModel, RefusesWhatCannotRunFreely) {
  PreparedDataset dataset = DatasetOf({kFF}, 1e-3);
  for (PreparedRow& row : dataset.rows) row.delta.starboard = row.delta.port;
  const auto model = EstimateModel(dataset, {});
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().subject, "SWAY");
}

/// From a recording to bounds: every coefficient bounded, the disturbance estimated.
TEST(Identify, BoundsARecordingWithTheWeakForm) {
  IdentifyOptions options;
  options.estimator = Estimator::kWeakIv;
  options.parametric_replicates = 8;
  std::vector<std::string> stages;
  const Recording recording =
      testing::SimulateStableBoat(testing::StableBoat(), 600.0, SensorOptions{}, 31);
  const auto result = Identify(recording, testing::StableBoatVehicle(), options,
                               [&](std::string_view stage, double) { stages.emplace_back(stage); });
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->estimator, Estimator::kWeakIv);
  ASSERT_EQ(result->coefficients.size(), 35U);
  const Eigen::VectorXd truth = testing::StableBoat().theta[0];
  for (std::size_t i = 0; i < 35; ++i) {
    const Coefficient& c = result->coefficients[i];
    EXPECT_EQ(c.status, CoefficientStatus::kEstimated);
    EXPECT_TRUE(std::isfinite(c.standard_error) && c.standard_error > 0.0) << c.regressor;
    const auto at = static_cast<Eigen::Index>(i);
    // Nine coefficients of a boat that is in the model class: five standard errors is never.
    if (i < 9) {
      EXPECT_NEAR(c.estimate, truth[at], 5.0 * c.standard_error) << c.regressor;
    }
  }
  ASSERT_TRUE(result->disturbance.has_value());
  EXPECT_EQ(
      result->provenance.parametric_replicates + result->provenance.parametric_replicate_failures,
      8U);
  EXPECT_NE(std::find(stages.begin(), stages.end(), "simulating replicates"), stages.end());
  EXPECT_TRUE(ModelOf(*result)->discretisation == Discretisation::kContinuous);
}

TEST(Identify, WithoutReplicatesTheWeakFormSaysThatBiasIsLeft) {
  IdentifyOptions options;
  options.estimator = Estimator::kWeakIv;
  options.parametric_replicates = 0;
  const auto result =
      Identify(testing::SimulateStableBoat(testing::StableBoat(), 600.0, SensorOptions{}, 31),
               testing::StableBoatVehicle(), options);
  ASSERT_TRUE(result.has_value());
  EXPECT_NE(result->provenance.bounds_basis.find("not corrected for bias"), std::string::npos);
  EXPECT_FALSE(result->disturbance.has_value());
}

TEST(IdentifyOptions, AskForOneKernelWithTheWeakForm) {
  IdentifyOptions options;
  options.prepare = PrepareOptions::Paper();
  ASSERT_TRUE(options.Validate().has_value());
  EXPECT_EQ(options.Validate()->subject, "estimator");
  options.estimator = Estimator::kOutputError;
  EXPECT_TRUE(options.Validate().has_value());
  options.estimator = Estimator::kOneStep;
  EXPECT_FALSE(options.Validate().has_value());
  options.estimator = Estimator::kUnknown;
  EXPECT_TRUE(options.Validate().has_value());
  options = {};
  options.parametric_replicates = 7;
  ASSERT_TRUE(options.Validate().has_value());
  EXPECT_NE(options.Validate()->advice.find("[8, 1000]"), std::string::npos);
}

TEST(IdentifyOptions, NameTheFieldTheValueAndTheRange) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 7;
  const auto refusal = options.Validate();
  ASSERT_TRUE(refusal.has_value());
  EXPECT_EQ(refusal->subject, "identification");
  EXPECT_NE(refusal->reason.find("bootstrap_replicates = 7"), std::string::npos);
  EXPECT_NE(refusal->advice.find("[100, 100000]"), std::string::npos);

  options = {};
  options.interval_level = 95.0;
  EXPECT_NE(options.Validate()->reason.find("interval_level = 95"), std::string::npos);
  options = {};
  options.threads = 0;
  EXPECT_NE(options.Validate()->reason.find("threads = 0"), std::string::npos);
  options = {};
  options.excitation.command_spread = std::nan("");
  EXPECT_EQ(options.Validate()->subject, "excitation");
  EXPECT_NE(options.Validate()->reason.find("command_spread"), std::string::npos);
}

}  // namespace
}  // namespace telltale
