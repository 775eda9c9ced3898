#include "telltale/core/diagnosis/hypotheses/cross_validation.hpp"

#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"

namespace telltale {
namespace {

TEST(WindowsOf, AreThoseOfTheFold) {
  EXPECT_EQ(WindowsOf({0, 1, 1, 0}, 0), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(WindowsOf({0, 1, 1, 0}, 1), (std::vector<std::size_t>{1, 2}));
}

/// Half a minute of data, half a minute without, half a minute of data.
TEST(FoldsOf, AreBothNonEmptyDespiteGaps) {
  PreparedDataset torn = testing::SimulateWithEffects({}, 120.0, 500);
  const auto half_minute = static_cast<std::size_t>(30.0 / torn.sampling_period_s) + 1;
  const std::size_t first = torn.segments.front().begin;
  torn.segments = {{first, first + half_minute},
                   {first + 2 * half_minute, first + 3 * half_minute}};
  torn.commands.assign(2, torn.commands.front());
  torn.signals.assign(2, torn.signals.front());
  const UncertainModel model = UncertainModelOf(testing::KnownStableBoat()).value();
  const FreeRuns runs(torn, model.model, 5.0);
  const auto folds = FoldsOf(runs);
  for (std::size_t fold = 0; fold < kFolds; ++fold) EXPECT_GE(WindowsOf(folds, fold).size(), 5U);
}

}  // namespace
}  // namespace telltale
