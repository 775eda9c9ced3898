#pragma once

#include <string_view>

namespace telltale {

/// The version of this software, "0.1.0": what models and reports say they were made by.
std::string_view Version();

}  // namespace telltale
