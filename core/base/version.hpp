#pragma once

#include <string_view>

namespace telltale {

/// The version of this software, "0.2.0". Models and reports name the version that made them.
std::string_view Version();

}  // namespace telltale
