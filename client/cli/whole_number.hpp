#pragma once

#include <algorithm>
#include <string>

#include <CLI/CLI.hpp>

namespace telltale {

/// For options that count: CLI11 alone would take -1 for the largest number there is, or say only
/// that it could not convert. What counts are allowed is for those to say who use them.
inline CLI::Validator WholeNumber() {
  return CLI::Validator(
      [](const std::string& text) {
        const bool digits =
            std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
        return !text.empty() && digits ? "" : text + " must be a whole number, 0 or more";
      },
      "");
}

}  // namespace telltale
