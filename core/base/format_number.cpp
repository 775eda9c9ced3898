#include "telltale/core/base/format_number.hpp"

#include <array>
#include <cstdio>

namespace telltale {

std::string Number(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

}  // namespace telltale
