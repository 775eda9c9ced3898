#include "telltale/core/estimation/regression/dead_zone_estimate.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

/// Commands of every size in FF, FR and RF, held for three steps, none above `widest`, none below
/// `least`.
std::vector<PropellerCommand> Commands(std::size_t steps, double least, double widest) {
  RandomEngine engine(3);
  boost::random::uniform_real_distribution<double> size(least, widest);
  std::vector<PropellerCommand> commands;
  for (std::size_t k = 0; commands.size() < steps; ++k) {
    const double port = size(engine);
    const double starboard = size(engine);
    const PropellerCommand command{k % 3 == 1 ? -port : port, k % 3 == 2 ? -starboard : starboard};
    commands.insert(commands.end(), 3, command);
  }
  commands.resize(steps);
  return commands;
}

VesselModel Boat(Structure structure, const DeadZone& limits) {
  VesselModel model = YellowfishTwin();
  model.structure = structure;
  model.discretisation = Discretisation::kForwardEuler;
  model.dead_zone = limits;
  if (structure == Structure::kFirstOrderDynamic) model.thruster_time_constant_s = 0.3;
  return model;
}

PreparedDataset Drive(const VesselModel& model, const std::vector<PropellerCommand>& commands,
                      double noise_mps = 0.0) {
  PreparedDataset dataset = testing::DriveDiscrete(model, commands, 60);
  VesselState state;
  for (PreparedRow& row : dataset.rows) {
    row.nu = state.nu;
    state = Advance(model, state, row.delta, model.sampling_period_s);
  }
  RandomEngine engine(4);
  boost::random::normal_distribution<double> noise(0.0, noise_mps);
  if (noise_mps == 0.0) return dataset;
  for (PreparedRow& row : dataset.rows) {
    row.nu.u += noise(engine);
    row.nu.v += noise(engine);
    row.nu.r += noise(engine);
  }
  return dataset;
}

RegressionOptions Fitted(Structure structure) {
  RegressionOptions options;
  options.structure = structure;
  return options;
}

struct Case {
  Structure structure;
  DeadZone limits;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << Name(c.structure) << ' ' << c.limits.forward << ' ' << c.limits.reverse;
}

class KnownDeadZone : public ::testing::TestWithParam<Case> {};

/// Data made by the discrete model give the limits back to the last step of the search, however few
/// they are: 300 rows are twice what thirteen coefficients ask for.
TEST_P(KnownDeadZone, IsRecovered) {
  const auto& [structure, limits] = GetParam();
  const auto dataset = Drive(Boat(structure, limits), Commands(300, 0.0, 0.8));
  const auto estimate = EstimateDeadZone(dataset, Fitted(structure), {}, 2);
  ASSERT_TRUE(estimate.has_value());
  EXPECT_NEAR(estimate->forward.estimate, limits.forward, 2e-5);
  EXPECT_NEAR(estimate->reverse.estimate, limits.reverse, 2e-5);
  EXPECT_TRUE(estimate->forward.determined);
  EXPECT_TRUE(estimate->reverse.determined);
}

INSTANTIATE_TEST_SUITE_P(Limits, KnownDeadZone,
                         ::testing::Values(Case{Structure::kStaticQuadratic, {0.07, -0.09}},
                                           Case{Structure::kStaticQuadratic, {0.0, 0.0}},
                                           Case{Structure::kStaticQuadratic, {0.123, 0.0}},
                                           Case{Structure::kFirstOrderDynamic, {0.06, -0.11}}));

/// With 1 mm/s of noise on velocities 0.2 s apart the limits stay within a hundredth of full
/// command.
TEST(EstimateDeadZone, NoiseMovesItLittle) {
  const auto dataset =
      Drive(Boat(Structure::kStaticQuadratic, {0.07, -0.09}), Commands(3000, 0.0, 0.8), 1e-3);
  const auto estimate = EstimateDeadZone(dataset, Fitted(Structure::kStaticQuadratic), {}, 2);
  ASSERT_TRUE(estimate.has_value());
  EXPECT_NEAR(estimate->forward.estimate, 0.07, 0.01);
  EXPECT_NEAR(estimate->reverse.estimate, -0.09, 0.01);
}

/// Data in which only noise is left to explain, since reverse is never commanded: flat over that
/// limit.
TEST(EstimateDeadZone, NamesTheUndeterminedLimit) {
  std::vector<PropellerCommand> commands = Commands(1500, 0.0, 0.8);
  for (PropellerCommand& c : commands) c = {std::abs(c.port), std::abs(c.starboard)};
  const auto dataset = Drive(Boat(Structure::kStaticQuadratic, {0.07, -0.09}), commands, 1e-4);
  const auto estimate = EstimateDeadZone(dataset, Fitted(Structure::kStaticQuadratic), {}, 2);
  ASSERT_TRUE(estimate.has_value());
  EXPECT_TRUE(estimate->forward.determined);
  EXPECT_FALSE(estimate->reverse.determined);
  EXPECT_LT(estimate->reverse.contrast, 1e-6);
}

TEST(EstimateDeadZone, DoesNotDependOnThreads) {
  const auto dataset =
      Drive(Boat(Structure::kStaticQuadratic, {0.07, -0.09}), Commands(600, 0.0, 0.8), 1e-3);
  const auto one = EstimateDeadZone(dataset, Fitted(Structure::kStaticQuadratic), {}, 1);
  const auto two = EstimateDeadZone(dataset, Fitted(Structure::kStaticQuadratic), {}, 2);
  EXPECT_EQ(one->forward.estimate, two->forward.estimate);
  EXPECT_EQ(one->reverse.contrast, two->reverse.contrast);
}

TEST(EstimateDeadZone, RefusesDataThatDetermineNoEquation) {
  const std::vector<PropellerCommand> still(500, PropellerCommand{0.5, 0.5});
  const auto dataset = Drive(Boat(Structure::kStaticQuadratic, {}), still);
  EXPECT_FALSE(EstimateDeadZone(dataset, Fitted(Structure::kStaticQuadratic), {}, 1));
}

TEST(IdentifyWithADeadZone, WritesTheLimitsAndTheUndeterminedOnes) {
  std::vector<PropellerCommand> commands = Commands(1500, 0.0, 0.8);
  const auto dataset = Drive(Boat(Structure::kStaticQuadratic, {0.07, -0.09}), commands, 1e-4);
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 0;
  options.dead_zone_source = DeadZoneSource::kIdentified;
  const auto all = Identify(dataset, "boat", options);
  ASSERT_TRUE(all.has_value());
  EXPECT_NEAR(all->dead_zone.forward, 0.07, 1e-3);
  EXPECT_NEAR(all->dead_zone.reverse, -0.09, 1e-3);

  for (PropellerCommand& c : commands) c = {std::abs(c.port), std::abs(c.starboard)};
  options.regression.dead_zone = {0.02, -0.03};
  const auto forward = Identify(
      Drive(Boat(Structure::kStaticQuadratic, {0.07, -0.09}), commands, 1e-4), "boat", options);
  ASSERT_TRUE(forward.has_value());
  EXPECT_NEAR(forward->dead_zone.forward, 0.07, 1e-3);
  EXPECT_EQ(forward->dead_zone.reverse, -0.03);
  bool said = false;
  for (const Refusal& refusal : forward->refusals) said |= refusal.subject == "dead zone, reverse";
  EXPECT_TRUE(said);
}

TEST(IdentifyOptions, RefuseADeadZoneOutOfItsRange) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.regression.dead_zone = {0.31, 0.0};
  ASSERT_TRUE(options.Validate().has_value());
  EXPECT_NE(options.Validate()->reason.find("[0, 0.3]"), std::string::npos);
  options.regression.dead_zone = {0.0, 0.01};
  EXPECT_TRUE(options.Validate().has_value());
  options.regression.dead_zone = {0.3, -0.3};
  EXPECT_FALSE(options.Validate().has_value());
}

}  // namespace
}  // namespace telltale
