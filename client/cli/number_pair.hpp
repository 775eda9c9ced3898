#pragma once

#include <string>
#include <utility>

namespace telltale {

/// "0.05,-0.06". Throws: UsageError naming the option and what it should be given, `expected`.
std::pair<double, double> NumberPair(const std::string& option, const std::string& text,
                                     const std::string& expected);

}  // namespace telltale
