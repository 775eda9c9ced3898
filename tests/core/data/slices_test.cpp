#include "telltale/core/data/slices.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(CutSlices, PartitionAtRegionsAndAtTheLongest) {
  std::vector<PreparedRow> rows(12);
  for (std::size_t i = 5; i < 8; ++i) rows[i].region = PropellerRegion::kFR;
  const auto slices = CutSlices(rows, {1, 12}, 3);
  const std::vector<std::size_t> ends = {4, 5, 8, 11, 12};
  ASSERT_EQ(slices.size(), ends.size());
  std::size_t begin = 1;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    EXPECT_EQ(slices[i].begin, begin);
    EXPECT_EQ(slices[i].end, ends[i]);
    begin = ends[i];
  }
}

}  // namespace
}  // namespace telltale
