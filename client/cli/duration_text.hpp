#pragma once

#include <string>

namespace telltale {

/// A time span in the unit that suits it: "42 s", "7 min", "3.5 h", "12 d". Negative ones are 0 s.
std::string DurationText(double seconds);

}  // namespace telltale
