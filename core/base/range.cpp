#include "telltale/core/base/range.hpp"

#include <cmath>
#include <sstream>

namespace telltale {
namespace {

std::string Describe(double low, double high) {
  std::ostringstream range;
  if (std::isinf(high)) {
    range << "at least " << low;
  } else if (std::isinf(low)) {
    range << "at most " << high;
  } else {
    range << "within [" << low << ", " << high << "]";
  }
  return range.str();
}

}  // namespace

std::optional<Refusal> OutOfRange(std::string_view subject, std::string_view field, double value,
                                  double low, double high) {
  if (value >= low && value <= high) return std::nullopt;
  const std::string range = Describe(low, high);
  std::ostringstream reason;
  reason << field << " = " << value << " must be " << range;
  return Refusal{std::string(subject), reason.str(),
                 "set " + std::string(field) + " to a value " + range};
}

}  // namespace telltale
