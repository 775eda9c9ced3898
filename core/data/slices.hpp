#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// Cuts `segment` of `rows` at each change of region and so that no slice has more than
/// `longest` rows. The slices partition the segment.
std::vector<RowRange> CutSlices(std::span<const PreparedRow> rows, const RowRange& segment,
                                std::size_t longest);

}  // namespace telltale
