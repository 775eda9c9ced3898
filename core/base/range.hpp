#pragma once

#include <optional>
#include <string_view>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// A refusal that names subject, field, value and range, unless low <= value <= high. NaN is
/// outside every range. With an infinite bound the text says "at least" or "at most".
std::optional<Refusal> OutOfRange(std::string_view subject, std::string_view field, double value,
                                  double low, double high);

}  // namespace telltale
