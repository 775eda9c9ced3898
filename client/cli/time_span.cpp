#include "telltale/client/cli/time_span.hpp"

#include <charconv>
#include <system_error>

namespace telltale {
namespace {

std::optional<double> SecondsPer(std::string_view unit) {
  if (unit.empty() || unit == "s") return 1.0;
  if (unit == "min") return 60.0;
  if (unit == "h") return 3600.0;
  if (unit == "d") return 86400.0;
  return std::nullopt;
}

}  // namespace

std::optional<double> SecondsOf(std::string_view text) {
  constexpr double kLongestS = 100.0 * 366.0 * 86400.0;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  const auto unit = SecondsPer(text.substr(static_cast<std::size_t>(end - text.data())));
  if (!unit || !(number >= 0.0) || number * *unit > kLongestS) return std::nullopt;
  return number * *unit;
}

}  // namespace telltale
