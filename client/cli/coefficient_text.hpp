#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/cli/table.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// "ONE_STEP" -> "one step".
std::string InWords(std::string_view name);

/// "95 % bounds", at the level of the model's intervals.
std::string BoundsTitle(const Identification& identification);

/// "[-0.1234, 0.5678]", both ends times `scale`.
std::string BoundsText(const Interval& interval, double scale = 1.0);

/// A table of the coefficients of all equations, grouped by equation. `cells` makes a row of a
/// coefficient and its place among them.
std::string CoefficientRows(
    const Identification& identification, std::vector<Column> columns,
    const std::function<std::vector<std::string>(const Coefficient&, std::size_t)>& cells);

}  // namespace telltale
