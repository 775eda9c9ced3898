#include "telltale/core/identification/input_gain.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <boost/random/normal_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

Identification Lagging(double tau_s, double tau_error_s) {
  Identification made = IdentificationByHand();
  made.structure = Structure::kFirstOrderDynamic;
  made.thruster_time_constant = Coefficient{
      Equation::kUnknown,           "", "tau", tau_s, tau_error_s, {0.95, 0.0, 1.0}, "s",
      CoefficientStatus::kEstimated};
  made.time_constant_covariance =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(made.coefficients.size()));
  return made;
}

// Port 0.5: 2 0.25 + 3 0.5 = 2. Starboard -0.2: -4 0.04 - 5 0.2 = -1.16. Sum 0.84, difference 3.16.
TEST(SteadyInputGain, IsTheHandWorkedSumAndDifference) {
  const InputGain gain = SteadyInputGain(IdentificationByHand(), {0.5, -0.2});
  EXPECT_NEAR(gain.gain[0], 0.84, 1e-15);
  EXPECT_NEAR(gain.gain[1], 0.5 * 3.16, 1e-15);
  EXPECT_NEAR(gain.gain[2], 2.0 * 3.16, 1e-15);
  // Regressors 0.25, 0.5, 0.04, -0.2 (differences -0.04, 0.2): squares sum to 0.3541.
  for (const double error : gain.StandardErrors())
    EXPECT_NEAR(error, std::sqrt(0.3541 + 0.0), 1e-4);
  EXPECT_NEAR(gain.covariance(0, 1), 0.0, 1e-15);
}

TEST(SteadyInputGain, TimesThePeriodIsThePapersGain) {
  const InputGain gain = SteadyInputGain(IdentificationByHand(), {0.5, -0.2});
  EXPECT_NEAR(gain.Times(0.2).gain[0], 0.168, 1e-15);
  EXPECT_NEAR(gain.Times(0.2).StandardErrors()[2], 0.2 * gain.StandardErrors()[2], 1e-15);
}

// The paper's own numbers: G_u(k) = X_u(6) (mean^2 + diff^2 / 4) + X_u(7) mean.
TEST(SteadyInputGain, IsThePapersFormulaOnThePapersTable) {
  Identification made = MadeUpIdentification(Parameterization::kPaper);
  made.dead_zone = {};
  for (std::size_t i = 0; i < 7; ++i) {
    made.coefficients[i].estimate = kYellowfishStaticTable.surge[i] / 0.2;
  }
  const auto& X = kYellowfishStaticTable.surge;
  const double mean = 0.45;
  const double difference = 0.3;
  const double expected = X[5] * (mean * mean + difference * difference / 4) + X[6] * mean;
  EXPECT_NEAR(SteadyInputGain(made, {0.6, 0.3}).Times(0.2).gain[0], expected,
              1e-12 * std::abs(expected));
}

TEST(SteadyInputGain, NeutralIsNoGainKnownExactly) {
  const InputGain gain = SteadyInputGain(IdentificationByHand(), {0.0, 0.0});
  EXPECT_TRUE(gain.gain.isZero(0.0));
  EXPECT_TRUE(gain.covariance.isZero(0.0));
}

TEST(SteadyInputGain, TheDeadZoneGivesNothing) {
  Identification made = IdentificationByHand();
  made.dead_zone = {0.1, -0.1};
  EXPECT_TRUE(SteadyInputGain(made, {0.1, -0.1}).gain.isZero(0.0));
  EXPECT_NEAR(SteadyInputGain(made, {0.6, -0.3}).gain[0], 0.84, 1e-14);
}

/// The propagated covariance is that of the gain over draws of the coefficients. 20000 draws: a
/// covariance is off by 1 % of the deviations' product at one sigma, so 4 % is four sigma.
TEST(SteadyInputGain, CovarianceIsThatOfManyDraws) {
  Identification made = IdentificationByHand();
  const auto n = made.covariance.rows();
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n, [](Eigen::Index i, Eigen::Index j) {
        return std::sin(1.0 + static_cast<double>(3 * i + 7 * j)) / (1.0 + static_cast<double>(j));
      });
  made.covariance = root * root.transpose();
  const PropellerCommand command{0.7, -0.4};
  const InputGain exact = SteadyInputGain(made, command);
  RandomEngine engine(11);
  boost::random::normal_distribution<double> normal;
  constexpr int kDraws = 20000;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd whitened(n);
    for (double& value : whitened) value = normal(engine);
    const Eigen::VectorXd shift = root * whitened;
    Identification drawn = made;
    for (Eigen::Index i = 0; i < n; ++i) {
      drawn.coefficients[static_cast<std::size_t>(i)].estimate += shift[i];
    }
    const Eigen::Vector3d apart = SteadyInputGain(drawn, command).gain - exact.gain;
    sum += apart * apart.transpose();
  }
  const Eigen::Vector3d deviation = exact.StandardErrors();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(sum(i, j) / kDraws, exact.covariance(i, j), 0.04 * deviation[i] * deviation[j]);
    }
  }
}

TEST(SteadyInputGain, AnUnknownCoefficientCountsOnlyWhenItIsAtWork) {
  Identification made = IdentificationByHand();
  const Eigen::Index reverse = 7;  // surge r:d^2
  made.covariance(reverse, reverse) = kInfinity;
  EXPECT_TRUE(std::isfinite(SteadyInputGain(made, {0.5, 0.5}).covariance(0, 0)));
  const InputGain astern = SteadyInputGain(made, {-0.5, 0.5});
  EXPECT_EQ(astern.covariance(0, 0), kInfinity);
  EXPECT_TRUE(std::isfinite(astern.covariance(2, 2)));
}

TEST(SteadyInputGain, ARefusedEquationIsUnknown) {
  Identification made = IdentificationByHand();
  std::erase_if(made.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  const auto n = static_cast<Eigen::Index>(made.coefficients.size());
  made.covariance = Eigen::MatrixXd::Identity(n, n);
  const InputGain gain = SteadyInputGain(made, {0.5, -0.2});
  EXPECT_EQ(gain.gain[1], 0.0);
  EXPECT_EQ(gain.covariance(1, 1), kInfinity);
  EXPECT_NEAR(gain.gain[2], 2.0 * 3.16, 1e-15);
}

// ---- dynamic -----------------------------------------------------------------------------------

// From rest, one step of h = tau ln 2: alpha = 1/2, so half of the steady 0.84; then three
// quarters.
TEST(LaggedInputGain, FollowsThePapersRecursion) {
  const Identification model = Lagging(0.2 / std::log(2.0), 0.0);
  LaggedInputGain gain(model);
  EXPECT_TRUE(gain.Now().gain.isZero(0.0));
  EXPECT_NEAR(gain.Advance({0.5, -0.2}).gain[0], 0.42, 1e-14);
  EXPECT_NEAR(gain.Advance({0.5, -0.2}).gain[0], 0.63, 1e-14);
  EXPECT_NEAR(gain.InitialShare(), 0.25, 1e-14);
}

TEST(LaggedInputGain, AgreesWithTheStaticOneInSteadyState) {
  const Identification model = Lagging(0.3, 0.05);
  LaggedInputGain gain(model, {0.1, 0.9});
  InputGain settled;
  for (int k = 0; k < 200; ++k) settled = gain.Advance({0.5, -0.2});
  const InputGain steady = SteadyInputGain(model, {0.5, -0.2});
  EXPECT_TRUE(settled.gain.isApprox(steady.gain, 1e-12));
  EXPECT_TRUE(settled.covariance.isApprox(steady.covariance, 1e-12));
}

TEST(LaggedInputGain, TwoHalfStepsAreOneStep) {
  const Identification model = Lagging(0.3, 0.05);
  LaggedInputGain whole(model);
  LaggedInputGain halves(model);
  whole.Advance({0.5, -0.2}, 0.2);
  halves.Advance({0.5, -0.2}, 0.1);
  halves.Advance({0.5, -0.2}, 0.1);
  EXPECT_TRUE(halves.Now().gain.isApprox(whole.Now().gain, 1e-13));
  EXPECT_TRUE(halves.Now().covariance.isApprox(whole.Now().covariance, 1e-12));
}

/// The part of the bound that is the time constant's, against the gain differenced in tau.
TEST(LaggedInputGain, BoundHoldsTheTimeConstantsError) {
  const double error = 0.04;
  const auto run = [](const Identification& model) {
    LaggedInputGain gain(model, {0.2, 0.2});
    gain.Advance({0.8, -0.3}, 0.17);
    return gain.Advance({-0.1, 0.6}, 0.23);
  };
  const InputGain with = run(Lagging(0.3, error));
  const InputGain without = run(Lagging(0.3, 0.0));
  const double step = 1e-5;
  const Eigen::Vector3d slope =
      (run(Lagging(0.3 + step, 0.0)).gain - run(Lagging(0.3 - step, 0.0)).gain) / (2 * step);
  const Eigen::Matrix3d expected = error * error * slope * slope.transpose();
  EXPECT_TRUE((with.covariance - without.covariance).isApprox(expected, 1e-6));
}

/// Coefficients and lag vary together, the lag mostly with surge f:d. The propagated covariance is
/// that of many draws: of 20000, 1 % of the deviations' product at one sigma, so 4 % is four sigma.
/// Errors of 1 % of the lag leave nothing of second order to see.
TEST(LaggedInputGain, CovarianceIsThatOfManyDrawsOfLagAndCoefficientsTogether) {
  constexpr Eigen::Index kSurgeForward = 6;
  const double tau_error = 0.003;
  Identification made = Lagging(0.3, tau_error);
  const auto n = made.covariance.rows();
  const double error = 0.02;
  made.covariance = error * error * Eigen::MatrixXd::Identity(n, n);
  made.time_constant_covariance[kSurgeForward] = 0.9 * error * tau_error;
  const auto run = [](const Identification& model) {
    LaggedInputGain gain(model);
    gain.Advance({0.8, -0.3}, 0.17);
    return gain.Advance({0.9, 0.6}, 0.23);
  };
  const InputGain exact = run(made);
  RandomEngine engine(12);
  boost::random::normal_distribution<double> normal;
  constexpr int kDraws = 20000;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Identification drawn = made;
    const double common = normal(engine);
    for (Eigen::Index i = 0; i < n; ++i) {
      drawn.coefficients[static_cast<std::size_t>(i)].estimate +=
          error * (i == kSurgeForward ? common : normal(engine));
    }
    drawn.thruster_time_constant->estimate +=
        tau_error * (0.9 * common + std::sqrt(1.0 - 0.81) * normal(engine));
    const Eigen::Vector3d apart = run(drawn).gain - exact.gain;
    sum += apart * apart.transpose();
  }
  const Eigen::Vector3d deviation = exact.StandardErrors();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(sum(i, j) / kDraws, exact.covariance(i, j), 0.04 * deviation[i] * deviation[j]);
    }
  }
  // More thrust in steady state and a longer lag offset each other: taken apart they would add up.
  made.time_constant_covariance.setZero();
  EXPECT_GT(run(made).covariance(0, 0), 2.0 * exact.covariance(0, 0));
}

TEST(LaggedInputGain, NeedsTheDynamicStructure) {
  const Identification model = IdentificationByHand();
  EXPECT_THROW(LaggedInputGain{model}, ContractViolation);
}

// tau ln 100; 4.605 time constants.
TEST(SettlingTime, IsWhenTheInitialConditionIsGone) {
  EXPECT_NEAR(SettlingTime(0.3), 0.3 * 4.605170185988092, 1e-14);
  EXPECT_NEAR(SettlingTime(2.0, 0.5), 2.0 * 0.6931471805599453, 1e-14);
  EXPECT_EQ(SettlingTime(0.0), 0.0);
  EXPECT_THROW(SettlingTime(-1.0), ContractViolation);
  const Identification model = Lagging(0.3, 0.0);
  LaggedInputGain gain(model, {1.0, 1.0});
  gain.Advance({0.0, 0.0}, SettlingTime(0.3));
  EXPECT_NEAR(gain.InitialShare(), 0.01, 1e-14);
}

// ---- disturbance -------------------------------------------------------------------------------

struct Thrust {
  Structure structure;
};

void PrintTo(const Thrust& thrust, std::ostream* out) {
  *out << Name(thrust.structure);
}

class Reconstructed : public ::testing::TestWithParam<Thrust> {};

/// On rows made by the discrete model, sigma is the body part of the model at each row.
TEST_P(Reconstructed, IsTheBodyPartOfTheModelThatMadeTheData) {
  VesselModel model = YellowfishTwin();
  model.structure = GetParam().structure;
  model.discretisation = Discretisation::kForwardEuler;
  model.thruster_time_constant_s = 0.4;
  const auto commands =
      testing::RandomCommands(300, {PropellerRegion::kFF, PropellerRegion::kFR}, 2);
  PreparedDataset dataset = testing::DriveDiscrete(model, commands, 50);
  VesselState state;
  state.thrust = model.SteadyThrust(commands[0]);
  for (PreparedRow& row : dataset.rows) {
    row.nu = state.nu;
    state = Advance(model, state, row.delta, model.sampling_period_s);
  }
  const auto samples = ReconstructDisturbance(dataset, model);
  ASSERT_EQ(samples.size(), dataset.rows.size() - 1);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const NuDot body = model.AccelerationUnder({}, dataset.rows[k].nu);
    EXPECT_EQ(samples[k].time_s, dataset.rows[k].time_s);
    EXPECT_NEAR(samples[k].sigma.u, body.u, 1e-11);
    EXPECT_NEAR(samples[k].sigma.v, body.v, 1e-11);
    EXPECT_NEAR(samples[k].sigma.r, body.r, 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(Structures, Reconstructed,
                         ::testing::Values(Thrust{Structure::kStaticQuadratic},
                                           Thrust{Structure::kFirstOrderDynamic}));

TEST(ReconstructDisturbance, NeverStraddlesAGap) {
  const VesselModel model = YellowfishPaperModel();
  PreparedDataset dataset = testing::DriveDiscrete(
      model, std::vector<PropellerCommand>(10, PropellerCommand{0.5, 0.5}), 5);
  dataset.segments = {{0, 4}, {4, 4}, {4, 10}};
  const auto samples = ReconstructDisturbance(dataset, model);
  ASSERT_EQ(samples.size(), 3u + 5u);
  EXPECT_EQ(samples[2].time_s, dataset.rows[2].time_s);
  EXPECT_EQ(samples[3].time_s, dataset.rows[4].time_s);
}

}  // namespace
}  // namespace telltale
