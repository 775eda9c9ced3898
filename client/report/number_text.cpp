#include "telltale/client/report/number_text.hpp"

#include <cmath>
#include <cstdio>
#include <ctime>

namespace telltale {
namespace {

std::string Formatted(const char* format, int precision, double value) {
  char text[400];
  std::snprintf(text, sizeof text, format, precision, value);
  return text;
}

}  // namespace

std::string Significant(double value, int digits) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "-∞";
  std::string text = Formatted("%#.*g", digits, value);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string Fixed(double value, int decimals) {
  return std::isfinite(value) ? Formatted("%.*f", decimals, value) : Significant(value);
}

std::string Plain(double value) {
  return std::isfinite(value) ? Formatted("%.*g", 6, value) : Significant(value);
}

std::string Counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

std::string UtcText(double unix_s) {
  const auto seconds = static_cast<std::time_t>(unix_s);
  std::tm time{};
  char text[32];
  gmtime_r(&seconds, &time);
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &time);
  return text;
}

std::string ShareText(double share) {
  return Fixed(100.0 * share, 0) + " %";
}

}  // namespace telltale
