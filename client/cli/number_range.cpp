#include "telltale/client/cli/number_range.hpp"

#include <sstream>
#include <string>

namespace telltale {

CLI::Validator NumberWithin(double low, double high) {
  std::ostringstream range;
  range << '[' << low << " - " << high << ']';
  const auto check = [low, high, range = range.str()](const std::string& text) -> std::string {
    double value = 0.0;
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return "";
    return "Value " + text + " not in range " + range;
  };
  return CLI::Validator(check, "FLOAT in " + range.str());
}

}  // namespace telltale
