#include "telltale/core/diagnosis/residuals/operating_conditions.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::ElementsAre;

/// The bins in which the residual lies, of all regions and of those named.
std::vector<std::string> BinsOf(const AccelerationResidual& residual, bool of_regions) {
  std::vector<std::string> bins;
  for (const OperatingCondition& condition : OperatingConditions()) {
    if (condition.region.has_value() == of_regions && condition.holds(residual)) {
      bins.push_back(condition.bin);
    }
  }
  return bins;
}

// Compass points go clockwise from north: the third is east.
TEST(OperatingConditions, PlaceAResidualOnceInEachDivision) {
  AccelerationResidual residual;
  residual.region = PropellerRegion::kFR;
  residual.speed = SpeedBin(0.7);
  residual.octant = 2;
  residual.third = 1;
  residual.after_step = true;
  EXPECT_THAT(BinsOf(residual, false),
              ElementsAre("", "0.5 to 1.0 m/s", "heading E", "middle third", "after a step"));
  EXPECT_THAT(BinsOf(residual, true), ElementsAre("", "0.5 to 1.0 m/s"));
  residual.after_step = false;
  EXPECT_EQ(BinsOf(residual, false).back(), "steady commands");
}

TEST(OperatingConditions, BeginWithTheWholeRange) {
  EXPECT_FALSE(OperatingConditions().front().region);
  EXPECT_EQ(OperatingConditions().front().bin, "");
}

TEST(SpeedBin, BeginsAtItsLowerEdge) {
  EXPECT_EQ(SpeedBin(0.0), 0U);
  EXPECT_EQ(SpeedBin(0.499), 0U);
  EXPECT_EQ(SpeedBin(0.5), 1U);
  EXPECT_EQ(SpeedBin(1.0), 2U);
}

}  // namespace
}  // namespace telltale
