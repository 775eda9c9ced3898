#include "telltale/core/estimation/regression/entering_rows.hpp"

#include <algorithm>

namespace telltale {

EnteringRows::EnteringRows(const PreparedDataset& dataset, std::span<const Equation> equations,
                           const RegressionOptions& regression)
    : entering_until_(dataset.rows.size() + 1, 0) {
  for (std::size_t k = dataset.rows.size(); k-- > 0;) {
    const bool enters = std::ranges::all_of(equations, [&](Equation equation) {
      return Enters(dataset.rows[k].region, equation, regression);
    });
    entering_until_[k] = enters ? std::max(entering_until_[k + 1], k + 1) : 0;
  }
}

bool EnteringRows::All(std::size_t first, std::size_t count) const {
  return entering_until_[first] >= first + count;
}

std::vector<RowRange> EnteringRows::RunsIn(const RowRange& rows) const {
  std::vector<RowRange> runs;
  for (std::size_t k = rows.begin; k < rows.end;) {
    if (entering_until_[k] == 0) {
      ++k;
      continue;
    }
    runs.push_back({k, std::min(entering_until_[k], rows.end)});
    k = runs.back().end;
  }
  return runs;
}

}  // namespace telltale
