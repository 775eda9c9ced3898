#include "telltale/core/identification/estimator_selection.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/reference_boat.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/identification/output_error_estimate.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// What the rule makes of repeats of the boat.
std::vector<std::optional<Identification>> Repeated(double disturbed, const coverage::Boat& boat,
                                                    std::size_t repeats,
                                                    std::size_t parametric_replicates) {
  constexpr int kSlices = 15;
  std::vector<std::optional<Identification>> all(repeats);
  ForEachIndex(repeats, 2, [&](std::size_t i) {
    IdentifyOptions options;
    options.parametric_replicates = parametric_replicates;
    auto result = Identify(testing::SimulateReferenceBoat(disturbed, kSlices, 700 + i, boat),
                           coverage::VehicleOf(), options);
    if (result) all[i] = *std::move(result);
  });
  return all;
}

/// Share in percent of true coefficients within bounds.
double Held(const std::vector<std::optional<Identification>>& repeats) {
  const std::vector<double> truth = coverage::CoefficientsOf(coverage::ReferenceBoat());
  double held = 0.0;
  double of = 0.0;
  for (const auto& repeat : repeats) {
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const Interval& interval = repeat->coefficients.at(j).interval;
      held += interval.lower <= truth[j] && truth[j] <= interval.upper ? 1.0 : 0.0;
      of += 1.0;
    }
  }
  return 100.0 * held / of;
}

TEST(EstimatorSelection, IsOutputErrorWithoutDisturbanceAndItsBoundsHold) {
  const auto repeats = Repeated(0.0, coverage::ReferenceBoat(), 30, 20);
  int doubted = 0;
  for (const auto& repeat : repeats) {
    ASSERT_TRUE(repeat.has_value());
    if (repeat->estimator != Estimator::kOutputError) {
      ++doubted;
      continue;
    }
    EXPECT_THAT(repeat->provenance.estimator_choice, StartsWith("output error, since"));
    EXPECT_LE(repeat->provenance.misspecification, kLargestAcceptedMisspecification);
  }
  // The ratio itself is known to a tenth, so that one repeat in twenty or so is doubted.
  EXPECT_LE(doubted, 6);
  // 30 repeats of 35 coefficients that err together: known to a point and a half.
  EXPECT_GE(Held(repeats), 91.0);
}

TEST(EstimatorSelection, IsTheWeakFormUnderDisturbancesAndItsBoundsHold) {
  const auto repeats = Repeated(1.0, coverage::ReferenceBoat(), 24, 20);
  for (const auto& repeat : repeats) {
    ASSERT_TRUE(repeat.has_value());
    EXPECT_EQ(repeat->estimator, Estimator::kWeakIv) << repeat->provenance.estimator_choice;
    EXPECT_THAT(repeat->provenance.estimator_choice, HasSubstr("a disturbance shows"));
    EXPECT_TRUE(repeat->disturbance.has_value());
  }
  EXPECT_GE(Held(repeats), 91.0);
}

/// A twentieth of it hides in the sensors' noise as far as the weak form is concerned; simulating
/// finds it.
TEST(EstimatorSelection, IsTheWeakFormUnderDisturbancesThatHardlyShow) {
  for (const auto& repeat : Repeated(0.05, coverage::ReferenceBoat(), 6, 0)) {
    ASSERT_TRUE(repeat.has_value());
    EXPECT_EQ(repeat->estimator, Estimator::kWeakIv);
    EXPECT_THAT(repeat->provenance.estimator_choice, HasSubstr("misspecification ratio"));
  }
}

/// A thrust curve outside the model class: output error is precise enough to be wrong there.
TEST(EstimatorSelection, IsTheWeakFormForPropellersOutsideTheModelClass) {
  coverage::Boat boat = coverage::ReferenceBoat();
  boat.thrust_bend = 0.3;
  for (const auto& repeat : Repeated(0.0, boat, 6, 0)) {
    ASSERT_TRUE(repeat.has_value());
    EXPECT_EQ(repeat->estimator, Estimator::kWeakIv);
  }
}

TEST(EstimatorSelection, IsOverruledByName) {
  const Recording recording = testing::SimulateReferenceBoat(0.0, 15, 701);
  IdentifyOptions options;
  options.estimator = Estimator::kWeakIv;
  options.parametric_replicates = 0;
  const auto result = Identify(recording, coverage::VehicleOf(), options);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->estimator, Estimator::kWeakIv);
  EXPECT_EQ(result->provenance.estimator_choice, "");
}

}  // namespace
}  // namespace telltale
