#pragma once

#include <optional>
#include <string_view>

namespace telltale {

/// Seconds of "90", "90s", "30min", "12h" or "7d". Nothing for another text, a negative number and
/// more than 100 years.
std::optional<double> SecondsOf(std::string_view text);

}  // namespace telltale
