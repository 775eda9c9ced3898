#pragma once

#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// After a silence this long of all channels a boat may lie elsewhere, in another wind: what
/// follows is another recording.
inline constexpr double kSilenceBetweenRecordingsS = 60.0;

/// Where each of the recordings begins that silences longer than `silence_s` part from each other:
/// what Recording::starts_s wants. Empty where there are no samples.
std::vector<double> StartsAfterSilence(const Recording& recording, double silence_s);

}  // namespace telltale
