#pragma once

#include <string_view>

namespace telltale {

/// The version of this software, "0.2.0" for one, which models and reports carry.
std::string_view Version();

}  // namespace telltale
