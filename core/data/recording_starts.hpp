#pragma once

#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// After a silence of all channels for this long the boat may be elsewhere, in another wind: what
/// follows counts as another recording. Units: seconds.
inline constexpr double kSilenceBetweenRecordingsS = 60.0;

/// The start of each recording where silences longer than `silence_s` part them, for
/// Recording::starts_s. Empty where there are no samples.
std::vector<double> StartsAfterSilence(const Recording& recording, double silence_s);

}  // namespace telltale
