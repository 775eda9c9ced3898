#include "telltale/client/cli/duration_text.hpp"

#include <algorithm>

#include "telltale/client/report/number_text.hpp"

namespace telltale {

std::string DurationText(double seconds) {
  constexpr double kMinute = 60.0;
  constexpr double kHour = 60.0 * kMinute;
  constexpr double kDay = 24.0 * kHour;
  if (seconds < 2.0 * kMinute) return Fixed(std::max(seconds, 0.0), 0) + " s";
  if (seconds < 2.0 * kHour) return Fixed(seconds / kMinute, 0) + " min";
  if (seconds < 2.0 * kDay) return Fixed(seconds / kHour, 1) + " h";
  return Fixed(seconds / kDay, 0) + " d";
}

}  // namespace telltale
