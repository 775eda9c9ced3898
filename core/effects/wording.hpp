#pragma once

#include <string>
#include <vector>

#include "telltale/core/base/format_number.hpp"

namespace telltale {

/// "22 %" of a share of 0.22, without its sign.
std::string Percent(double share);

/// "22 % more" or "22 % less".
std::string PercentMoreOrLess(double share);

/// "wind and waves".
std::string Enumerated(const std::vector<std::string>& names);

/// "towards NE" of a vector north and east.
std::string Towards(double north, double east);

}  // namespace telltale
