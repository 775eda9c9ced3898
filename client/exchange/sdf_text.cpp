#include "telltale/client/exchange/sdf_text.hpp"

#include <array>
#include <charconv>

namespace telltale {

std::string Text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6)
                       .ptr;
  return {buffer.data(), end};
}

std::string Comment(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '-' && !safe.empty() && safe.back() == '-') safe += ' ';
    safe += c;
  }
  return "<!-- " + safe + " -->\n";
}

std::string Element(std::string_view name, double value, std::string_view remark) {
  const std::string tag(name);
  return "  <" + tag + '>' + Text(value) + "</" + tag + ">  " + Comment(remark);
}

}  // namespace telltale
