#pragma once

#include <vector>

#include "telltale/client/recording/time_order.hpp"

namespace telltale {

/// A recording may hold hours without power; a longer silence is cut to this.
inline constexpr double kLongestSilenceS = 60.0;

/// When each sample of a replay is due, in seconds since the first: ascending, and no silence
/// longer than kLongestSilenceS. A sample that is late is due at once. Where the clock jumps, ahead
/// or back by more than that, and the next sample agrees, later ones follow the new clock; a jump
/// back takes no time. A single wrong time, NaN included, is due at once and moves nothing.
/// Assumes: samples InOrderOfTime().
std::vector<double> DueTimes(const std::vector<RawSample>& samples);

}  // namespace telltale
