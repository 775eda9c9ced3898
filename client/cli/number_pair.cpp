#include "telltale/client/cli/number_pair.hpp"

#include "telltale/client/workbench/errors.hpp"

#include <charconv>
#include <optional>
#include <string_view>

namespace telltale {
namespace {

std::optional<double> Number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::pair<double, double> NumberPair(const std::string& option, const std::string& text,
                                     const std::string& expected) {
  const std::string_view whole = text;
  const std::size_t comma = whole.find(',');
  if (comma != std::string_view::npos) {
    const auto first = Number(whole.substr(0, comma));
    const auto second = Number(whole.substr(comma + 1));
    if (first && second) return {*first, *second};
  }
  throw UsageError(option + ' ' + text + ": give " + expected);
}

}  // namespace telltale
