#include "telltale/core/base/format_number.hpp"

#include <array>
#include <cstdio>

namespace telltale {

std::string FormatNumber(double value, int decimals) {
  std::array<char, 400> text{};  // the longest double has 309 digits before its point
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string FormatSignificant(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

}  // namespace telltale
