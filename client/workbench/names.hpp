#pragma once

#include <string>
#include <vector>

namespace telltale {

/// The names that an option takes.
using OptionNames = std::vector<std::string>;

/// Throws: UsageError naming the option, the value and the names there are, where `value` is none
/// of them.
void RequireOneOf(const OptionNames& names, const std::string& option, const std::string& value);

}  // namespace telltale
