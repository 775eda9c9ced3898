#include "telltale/core/diagnosis/hypotheses/shapley.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(ShapleyShares, OfOneMemberAreOne) {
  EXPECT_THAT(ShapleyShares({0.0, 7.0}), ElementsAre(1.0));
}

TEST(ShapleyShares, OfASymmetricPairAreOneHalfEach) {
  EXPECT_THAT(ShapleyShares({0.0, 2.0, 2.0, 10.0}), ElementsAre(0.5, 0.5));
}

TEST(ShapleyShares, OfIndependentMembersAreTheirOwnValues) {
  EXPECT_THAT(ShapleyShares({0.0, 1.0, 3.0, 4.0}), ElementsAre(0.25, 0.75));
}

TEST(ShapleyShares, OfAMemberThatAddsNothingAreZero) {
  EXPECT_THAT(ShapleyShares({0.0, 0.0, 3.0, 3.0}), ElementsAre(0.0, 1.0));
}

// The glove game: a left glove (member 0) and two right ones; only a pair has value.
TEST(ShapleyShares, OfTheGloveGameAreTwoThirdsAndOneSixthEach) {
  EXPECT_THAT(ShapleyShares({0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0}),
              ElementsAre(DoubleNear(2.0 / 3.0, 1e-15), DoubleNear(1.0 / 6.0, 1e-15),
                          DoubleNear(1.0 / 6.0, 1e-15)));
}

TEST(ShapleyShares, AreZeroWhereTheWholeHasNoValue) {
  EXPECT_THAT(ShapleyShares({0.0, 1.0, -1.0, 0.0}), ElementsAre(0.0, 0.0));
}

TEST(ShapleyShares, RequireAValueForEachSubset) {
  EXPECT_THROW(ShapleyShares({0.0, 1.0, 2.0}), ContractViolation);
  EXPECT_THROW(ShapleyShares({0.0}), ContractViolation);
}

}  // namespace
}  // namespace telltale
