#pragma once

#include <string_view>

namespace telltale {

/// A text without the blanks at its ends.
constexpr std::string_view Trimmed(std::string_view text, std::string_view blanks = " \t\r") {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// What files of other programs may begin with: the mark of UTF-8.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

}  // namespace telltale
