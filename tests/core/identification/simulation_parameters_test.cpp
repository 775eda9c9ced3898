#include "telltale/core/identification/simulation_parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/stable_boat.hpp"
#include "support/stable_boat_with_effects.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/free_run.hpp"

namespace telltale {
namespace {

const PreparedDataset& RecordedBoat() {
  static const PreparedDataset dataset =
      *Prepare(testing::SimulateStableBoat(testing::StableBoat(), 300.0, testing::NoNoise(), 5),
               testing::StableBoatVehicle(), {});
  return dataset;
}

/// SURGE u: driving, so that the boat accelerates without end, known to `standard_error`.
Identification Diverging(double standard_error) {
  Identification model = testing::KnownStableBoat();
  Coefficient& u = model.coefficients[3];
  u.estimate = 2.0;
  u.standard_error = standard_error;
  u.interval = {0.95, 2.0 - 2.0 * standard_error, 2.0 + 2.0 * standard_error};
  model.covariance(3, 3) = standard_error * standard_error;
  return model;
}

TEST(SimulationParameters, IsTheEstimateWhereThatIsStable) {
  Identification model = testing::KnownStableBoat();
  FindSimulationParameters(RecordedBoat(), model);
  EXPECT_TRUE(model.simulation.empty());
  EXPECT_TRUE(model.refusals.empty());
}

TEST(SimulationParameters, StaysWithinBoundsAndDoesNotDiverge) {
  Identification model = Diverging(3.0);
  const auto before = model.coefficients;
  FindSimulationParameters(RecordedBoat(), model);
  ASSERT_EQ(model.simulation.size(), 35U);
  for (std::size_t i = 0; i < 35; ++i) {
    ExpectSame(model.coefficients[i], before[i]);
    EXPECT_GE(model.simulation[i], before[i].interval.lower) << i;
    EXPECT_LE(model.simulation[i], before[i].interval.upper) << i;
  }
  for (const double horizon_s : {5.0, 15.0, 30.0}) {
    EXPECT_EQ(CountDivergences(RecordedBoat(), *ModelOf(model), horizon_s).diverged, 0U);
  }
  ASSERT_EQ(model.refusals.size(), 1U);
  EXPECT_THAT(model.refusals[0].reason, ::testing::HasSubstr("simulations use parameters"));
  // 2 / (1 + 9 / (t 2)^2), by hand: 0.62, 0.36, 0.20 for t = 1, 0.7, 0.5; drag u|u| of -0.35 holds
  // a push of 0.62 u to twice the fastest recorded, so that the first may do.
  EXPECT_LE(model.simulation[3], 0.62);
}

// Without noise least squares from one instant to the next sees the drag of -0.25 u, which no model
// that is drawn from a push of 2 u towards nothing comes to.
TEST(SimulationParameters, ShrinksToTheOneStepEstimate) {
  Identification model = Diverging(3.0);
  FindSimulationParameters(RecordedBoat(), model);
  ASSERT_EQ(model.simulation.size(), 35U);
  EXPECT_NEAR(model.simulation[3], testing::StableBoat().theta[0][3], 0.1);
}

TEST(SimulationParameters, LiesWithinTheEllipsoidWhereThereIsOne) {
  Identification model = Diverging(3.0);
  model.joint = JointBounds{1.0, 60.0};
  FindSimulationParameters(RecordedBoat(), model);
  ASSERT_EQ(model.simulation.size(), 35U);
  double distance = 0.0;
  for (Eigen::Index i = 0; i < 35; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double off = model.simulation[at] - model.coefficients[at].estimate;
    distance += off * off / model.covariance(i, i);
  }
  EXPECT_LE(distance, *SquaredRadius(model));
  EXPECT_EQ(CountDivergences(RecordedBoat(), *ModelOf(model), 30.0).diverged, 0U);
}

/// An ellipsoid so small that it holds no stable candidate, where the bounds of single ones would.
TEST(SimulationParameters, IsNoneWhereTheEllipsoidHoldsNoneThatIsStable) {
  Identification model = Diverging(3.0);
  model.joint = JointBounds{1e-6, 60.0};
  FindSimulationParameters(RecordedBoat(), model);
  EXPECT_TRUE(model.simulation.empty());
}

TEST(SimulationParameters, IsNoneWhereTheDataDetermineWhatDiverges) {
  Identification model = Diverging(0.01);
  FindSimulationParameters(RecordedBoat(), model);
  EXPECT_TRUE(model.simulation.empty());
  ASSERT_EQ(model.refusals.size(), 1U);
  EXPECT_THAT(model.refusals[0].reason, ::testing::HasSubstr("cannot be simulated"));
}

TEST(SimulationParameters, TheOneStepModelIsWarnedOfAndUnchanged) {
  Identification model = Diverging(3.0);
  model.estimator = Estimator::kOneStep;
  FindSimulationParameters(RecordedBoat(), model);
  EXPECT_TRUE(model.simulation.empty());
  ASSERT_EQ(model.refusals.size(), 1U);
  EXPECT_THAT(model.refusals[0].reason, ::testing::HasSubstr("diverges"));
}

TEST(SimulationParameters, ReplacesTheEstimatesOnRequest) {
  const Identification model = MadeUpIdentificationWithSimulationParameters();
  const Identification taken = WithSimulationParameters(model);
  EXPECT_EQ(taken.coefficients[7].estimate, model.simulation[7]);
  EXPECT_EQ(taken.coefficients[7].interval.lower, model.coefficients[7].interval.lower);
  EXPECT_EQ(ModelOf(taken)->theta[0], ModelOf(model)->theta[0]);
}

}  // namespace
}  // namespace telltale
