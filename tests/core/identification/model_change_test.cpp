#include "telltale/core/identification/model_change.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "telltale/core/identification/model_comparison.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

/// 32 boat coefficients of unit variance known for certain, so that d'V^-1 d = sum d^2 / 2.
Identification Known() {
  Identification known = IdentificationByHand();
  known.provenance = {};
  return known;
}

Identification Later(Identification earlier, std::size_t coefficient, double sigmas) {
  earlier.coefficients[coefficient].estimate += std::sqrt(2.0) * sigmas;
  return earlier;
}

// Chi-square with 32 degrees of freedom: P(> 53.486) = 0.01, Abramowitz and Stegun, table 26.8.
TEST(ChangeBetween, CallsModelsDifferentBeyondOnePercent) {
  const Identification earlier = Known();
  const auto below = ChangeBetween(earlier, Later(earlier, 13, std::sqrt(53.4)));
  const auto above = ChangeBetween(earlier, Later(earlier, 13, std::sqrt(53.6)));
  ASSERT_TRUE(below && above);
  EXPECT_EQ(below->degrees_of_freedom, 32u);
  EXPECT_EQ(below->verdict, ChangeVerdict::kNoSignificantChange);
  EXPECT_EQ(above->verdict, ChangeVerdict::kChanged);
  EXPECT_NEAR(above->statistic, 53.6, 1e-9);
}

TEST(ChangeBetween, NamesWhatChangedLaterLessEarlier) {
  const Identification earlier = Known();
  const auto change = ChangeBetween(earlier, Later(earlier, 13, -9.0));
  ASSERT_TRUE(change);
  ASSERT_EQ(change->coefficients.size(), 32u);
  EXPECT_EQ(change->coefficients[0].equation, Equation::kSway);
  EXPECT_EQ(change->coefficients[0].regressor, "uv");
  EXPECT_NEAR(change->coefficients[0].Sigmas(), -9.0, 1e-12);
  EXPECT_EQ(change->coefficients[1].Sigmas(), 0.0);
}

// Wind is no property of the boat.
TEST(ChangeBetween, DoesNotMindAnotherSteadyDisturbance) {
  const Identification earlier = Known();
  ASSERT_EQ(earlier.coefficients[4].regressor, "1");
  const auto change = ChangeBetween(earlier, Later(earlier, 4, 100.0));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->verdict, ChangeVerdict::kNoSignificantChange);
}

TEST(ChangeBetween, CountsClustersAsWhatCovariancesWereEstimatedFrom) {
  Identification earlier = Known();
  earlier.provenance.clusters = 60;
  const Identification later = Later(earlier, 13, std::sqrt(53.6));
  EXPECT_EQ(ChangeBetween(earlier, later)->verdict, ChangeVerdict::kNoSignificantChange);
  earlier.provenance.clusters = 10;
  EXPECT_FALSE(ChangeBetween(earlier, earlier));  // 18 degrees of freedom are too few for 32
}

TEST(WindowsOverlap, WhereTheyMayShareData) {
  Identification first = Known();
  Identification second = Known();
  first.window.start_s = 0.0;
  first.window.end_s = 100.0;
  second.window.start_s = 100.0;
  second.window.end_s = 200.0;
  EXPECT_FALSE(WindowsOverlap(first, second));
  EXPECT_FALSE(WindowsOverlap(second, first));
  second.window.start_s = 99.0;
  EXPECT_TRUE(WindowsOverlap(first, second));
  EXPECT_TRUE(WindowsOverlap(first, first));
}

TEST(ModelChange, NamesParametersOfThePhysicalFormByTheirSymbols) {
  Identification earlier = MadeUpPhysicalIdentification();
  earlier.physical->covariance.setIdentity();
  earlier.physical->covariance *= 1e-6;
  Identification later = earlier;
  later.physical->parameters[static_cast<std::size_t>(At(FossenParameter::kXuu))].estimate += 1.0;
  const auto change = ChangeBetween(earlier, later);
  ASSERT_TRUE(change);
  EXPECT_THAT(InWords(*change), HasSubstr(", Xuu by +"));
}

TEST(ModelChange, IsToldInASentence) {
  ModelChange change = MadeUpChange();
  EXPECT_EQ(InWords(change),
            "differs from revision 3: p = 0.0021, YAW r|r| by +3.4 sigma, thruster time constant "
            "by -2.0 sigma; fouling, damage or another load?");
  change.verdict = ChangeVerdict::kNoSignificantChange;
  change.p_value = 0.41;
  EXPECT_EQ(InWords(change), "is no different from revision 3: p = 0.41");
  change.verdict = ChangeVerdict::kInconclusive;
  change.reason = "too little";
  EXPECT_EQ(InWords(change), "cannot be compared with revision 3: too little");
  change.revision = 0;
  EXPECT_THAT(InWords(change), HasSubstr("compared with earlier models"));
}

}  // namespace
}  // namespace telltale
