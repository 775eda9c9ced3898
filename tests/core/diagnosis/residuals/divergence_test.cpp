#include <limits>

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Divergence, IsWorseInMoreWindowsOrMuchFarther) {
  constexpr Divergence kOneALittle{1, 1.5};
  EXPECT_FALSE(kOneALittle.IsWorseThan(kOneALittle));
  EXPECT_TRUE((Divergence{2, 1.5}).IsWorseThan(kOneALittle));
  EXPECT_FALSE((Divergence{1, 2.9}).IsWorseThan(kOneALittle));
  EXPECT_TRUE((Divergence{1, 3.1}).IsWorseThan(kOneALittle));
  EXPECT_TRUE((Divergence{1, kInfinity}).IsWorseThan(kOneALittle));
  EXPECT_FALSE((Divergence{0, 0.9}).IsWorseThan(Divergence{0, 0.2}));  // neither passes its limit
}

TEST(Divergence, AddsWindowsAndKeepsTheFarthest) {
  Divergence both{1, 1.5};
  both.Add({2, 1.2});
  EXPECT_EQ(both.windows, 3U);
  EXPECT_EQ(both.farthest, 1.5);
}

TEST(Divergence, IsNoneOfABoatThatIsTheModel) {
  const testing::ShortRecording recording;
  const Divergence none = recording.runs.DivergenceOf({recording.model.model, {}});
  EXPECT_EQ(none.windows, 0U);
  EXPECT_GT(none.farthest, 0.2);  // it reaches about half the limit, twice the fastest velocity
  EXPECT_LT(none.farthest, 1.0);
}

TEST(Divergence, IsWithoutBoundOfABoatThatDragDrives) {
  const testing::ShortRecording recording;
  VesselModel driven = recording.model.model;
  for (Eigen::VectorXd& theta : driven.theta) theta *= -20.0;
  const Divergence divergence = recording.runs.DivergenceOf({driven, {}});
  EXPECT_GT(divergence.windows, 0U);
  EXPECT_EQ(divergence.farthest, kInfinity);
}

TEST(Divergence, IsThatOfTheFreeRunsWhoseErrorsComeWithIt) {
  const testing::ShortRecording recording;
  VesselModel driven = recording.model.model;
  for (Eigen::VectorXd& theta : driven.theta) theta *= -20.0;
  for (const VesselModel& model : {recording.model.model, driven}) {
    const FreeRuns::Outcome outcome = recording.runs.OutcomeOf({model, {}});
    const Divergence alone = recording.runs.DivergenceOf({model, {}});
    EXPECT_EQ(outcome.errors, recording.runs.Errors({model, {}}));
    EXPECT_EQ(outcome.divergence.windows, alone.windows);
    EXPECT_EQ(outcome.divergence.farthest, alone.farthest);
  }
}

}  // namespace
}  // namespace telltale
