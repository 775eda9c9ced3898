#include "telltale/core/identification/sailed_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/augmented_boats.hpp"
#include "support/boats.hpp"
#include "support/identifications.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/free_run.hpp"

namespace telltale {
namespace {

const PreparedDataset& RecordedAfloat() {
  static const PreparedDataset dataset =
      *Prepare(testing::SailStableBoat(testing::StableBoat(), 300.0, testing::NoNoise(), 5),
               testing::StableBoatVehicle(), {});
  return dataset;
}

/// SURGE u: driving, so that the boat accelerates without end, known to `standard_error`.
Identification RunningAway(double standard_error) {
  Identification model = testing::KnownStableBoat();
  Coefficient& u = model.coefficients[3];
  u.estimate = 2.0;
  u.standard_error = standard_error;
  u.interval = {0.95, 2.0 - 2.0 * standard_error, 2.0 + 2.0 * standard_error};
  model.covariance(3, 3) = standard_error * standard_error;
  return model;
}

TEST(SailedModel, IsTheEstimateWhereThatSails) {
  Identification model = testing::KnownStableBoat();
  SeekToSail(RecordedAfloat(), model);
  EXPECT_TRUE(model.sailed.empty());
  EXPECT_TRUE(model.refusals.empty());
}

TEST(SailedModel, StaysWithinBoundsAndDoesNotRunAway) {
  Identification model = RunningAway(3.0);
  const auto before = model.coefficients;
  SeekToSail(RecordedAfloat(), model);
  ASSERT_EQ(model.sailed.size(), 35U);
  for (std::size_t i = 0; i < 35; ++i) {
    ExpectSame(model.coefficients[i], before[i]);
    EXPECT_GE(model.sailed[i], before[i].interval.lower) << i;
    EXPECT_LE(model.sailed[i], before[i].interval.upper) << i;
  }
  for (const double horizon_s : {5.0, 15.0, 30.0}) {
    EXPECT_EQ(CountRunaways(RecordedAfloat(), *ModelOf(model), horizon_s).runaways, 0U);
  }
  ASSERT_EQ(model.refusals.size(), 1U);
  EXPECT_THAT(model.refusals[0].reason, ::testing::HasSubstr("it is sailed with"));
  // 2 / (1 + 9 / (t 2)^2), by hand: 0.62, 0.36, 0.20 for t = 1, 0.7, 0.5; drag u|u| of -0.35 holds
  // a push of 0.62 u to twice the fastest recorded, so that the first may do.
  EXPECT_LE(model.sailed[3], 0.62);
}

// Without noise least squares from one instant to the next sees the drag of -0.25 u, which no model
// that is drawn from a push of 2 u towards nothing comes to.
TEST(SailedModel, ComesToWhatOneStepLeastSquaresSeesOfTheRecording) {
  Identification model = RunningAway(3.0);
  SeekToSail(RecordedAfloat(), model);
  ASSERT_EQ(model.sailed.size(), 35U);
  EXPECT_NEAR(model.sailed[3], testing::StableBoat().theta[0][3], 0.1);
}

TEST(SailedModel, LiesWithinTheEllipsoidWhereThereIsOne) {
  Identification model = RunningAway(3.0);
  model.joint = JointBounds{1.0, 60.0};
  SeekToSail(RecordedAfloat(), model);
  ASSERT_EQ(model.sailed.size(), 35U);
  double distance = 0.0;
  for (Eigen::Index i = 0; i < 35; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double off = model.sailed[at] - model.coefficients[at].estimate;
    distance += off * off / model.covariance(i, i);
  }
  EXPECT_LE(distance, *SquaredRadius(model));
  EXPECT_EQ(CountRunaways(RecordedAfloat(), *ModelOf(model), 30.0).runaways, 0U);
}

/// An ellipsoid so small that it holds none that sails, where the bounds of single ones would.
TEST(SailedModel, IsNoneWhereTheEllipsoidHoldsNoneThatSails) {
  Identification model = RunningAway(3.0);
  model.joint = JointBounds{1e-6, 60.0};
  SeekToSail(RecordedAfloat(), model);
  EXPECT_TRUE(model.sailed.empty());
}

TEST(SailedModel, IsNoneWhereTheDataAreSureOfWhatRunsAway) {
  Identification model = RunningAway(0.01);
  SeekToSail(RecordedAfloat(), model);
  EXPECT_TRUE(model.sailed.empty());
  ASSERT_EQ(model.refusals.size(), 1U);
  EXPECT_THAT(model.refusals[0].reason, ::testing::HasSubstr("not to be sailed"));
}

TEST(SailedModel, ThePapersRecipeIsWarnedOfAndLeft) {
  Identification model = RunningAway(3.0);
  model.estimator = Estimator::kOneStep;
  SeekToSail(RecordedAfloat(), model);
  EXPECT_TRUE(model.sailed.empty());
  ASSERT_EQ(model.refusals.size(), 1U);
  EXPECT_THAT(model.refusals[0].reason, ::testing::HasSubstr("runs away"));
}

TEST(SailedModel, TakesThePlaceOfTheEstimatesForWhoAsks) {
  const Identification model = MadeUpSailedIdentification();
  const Identification taken = AsSailed(model);
  EXPECT_EQ(taken.coefficients[7].estimate, model.sailed[7]);
  EXPECT_EQ(taken.coefficients[7].interval.lower, model.coefficients[7].interval.lower);
  EXPECT_EQ(ModelOf(taken)->theta[0], ModelOf(model)->theta[0]);
}

}  // namespace
}  // namespace telltale
