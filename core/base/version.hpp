#pragma once

#include <string_view>

namespace telltale {

/// The version of this software, "0.1.0", which models and reports carry.
std::string_view Version();

}  // namespace telltale
