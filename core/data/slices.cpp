#include "telltale/core/data/slices.hpp"

#include "telltale/core/base/contract.hpp"

namespace telltale {

std::vector<RowRange> CutSlices(std::span<const PreparedRow> rows, const RowRange& segment,
                                std::size_t longest) {
  Require(longest > 0, "slices of at least one row");
  std::vector<RowRange> slices;
  for (std::size_t row = segment.begin; row < segment.end; ++row) {
    const bool opens = row == segment.begin || rows[row].region != rows[row - 1].region ||
                       slices.back().size() == longest;
    if (opens) slices.push_back({row, row});
    slices.back().end = row + 1;
  }
  return slices;
}

}  // namespace telltale
