#include "telltale/core/estimation/weak_form/separable_columns.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/simulation/sensors.hpp"

namespace telltale {
namespace {

using ::testing::UnorderedElementsAre;

PreparedDataset SimulatedOnly(const Manoeuvre& manoeuvre) {
  PrepareOptions options;
  options.smoothing_half_width = 4;
  SensorOptions sensors;
  const Recording recording =
      Measure(Simulate(testing::StableBoat(), {}, Schedule({manoeuvre}, 0.0), 200.0, 0.02),
              testing::StableBoatVehicle(), sensors);
  return *Prepare(recording, testing::StableBoatVehicle(), options);
}

std::vector<std::string> NamesIn(const CollinearGroup& group, Equation equation) {
  const auto regressors = Regressors(equation, Parameterization::kPropeller);
  std::vector<std::string> names;
  for (const std::size_t column : group.columns) names.emplace_back(regressors[column].name);
  return names;
}

std::array<std::vector<std::size_t>, 3> WithoutReverse() {
  auto columns = AllColumns(Parameterization::kPropeller);
  for (auto& of_this : columns) of_this.resize(of_this.size() - 2);  // without thrust in reverse
  return columns;
}

/// One difference of the commands and its mirror image: d^2 is d times a number, exactly.
TEST(Separate, NamesWhatOneAmplitudeCannotPart) {
  const PreparedDataset dataset = SimulatedOnly(Repeated(Zigzag(0.55, 0.5, 1, 4.0), 200.0));
  std::array<std::vector<std::size_t>, 3> columns = WithoutReverse();
  columns[0].clear();
  const auto hindered = EstimateWeakIv(dataset, {}, columns, {});
  EXPECT_FALSE(hindered && ClusterCovariance(*hindered).allFinite());
  const SeparableColumns separable = Separate(dataset, {}, columns, {});
  for (const Equation equation : {Equation::kSway, Equation::kYaw}) {
    const auto& groups = separable.groups[IndexOf(equation)];
    ASSERT_FALSE(groups.empty());
    EXPECT_GT(groups[0].condition_index, 1e9);
    EXPECT_THAT(NamesIn(groups[0], equation), UnorderedElementsAre("f:d^2", "f:d"));
    EXPECT_EQ(separable.kept[IndexOf(equation)].size() + groups.size(),
              columns[IndexOf(equation)].size());
  }
  EXPECT_TRUE(separable.kept[0].empty());
  EXPECT_TRUE(EstimateWeakIv(dataset, {}, separable.kept, {}).has_value());
}

/// Two levels of the command are a straight line: d^2 = a d + b, so that the constant takes part.
TEST(Separate, NamesTheConstantWhereCommandsHaveTwoLevels) {
  const PreparedDataset dataset = SimulatedOnly(Repeated(SurgeSteps(0.2, 0.9, 1, 4.0), 200.0));
  const std::array<std::vector<std::size_t>, 3> surge = {WithoutReverse()[0], {}, {}};
  const SeparableColumns separable = Separate(dataset, {}, surge, {});
  ASSERT_EQ(separable.groups[0].size(), 1u);
  EXPECT_THAT(NamesIn(separable.groups[0][0], Equation::kSurge),
              UnorderedElementsAre("1", "f:d^2", "f:d"));
}

TEST(Separate, LeavesVariedCommandsAlone) {
  PrepareOptions options;
  options.smoothing_half_width = 4;
  const PreparedDataset dataset =
      *Prepare(testing::SimulateStableBoat(testing::StableBoat(), 300.0, {}, 2),
               testing::StableBoatVehicle(), options);
  const auto all = AllColumns(Parameterization::kPropeller);
  const SeparableColumns separable = Separate(dataset, {}, all, {});
  EXPECT_EQ(separable.kept, all);
  for (const auto& groups : separable.groups) EXPECT_TRUE(groups.empty());
}

}  // namespace
}  // namespace telltale
