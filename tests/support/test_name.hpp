#pragma once

#include <cctype>
#include <string>

namespace telltale {

/// The text with everything but letters and digits as '_': what may stand in the name of a test.
inline std::string AsTestName(std::string text) {
  for (char& c : text) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return text;
}

}  // namespace telltale
