#pragma once

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The time of the newest sample of any channel; 0 where there is none or all are older than 0.
double EndTime(const Recording& recording);

/// The samples of each channel later than `from_s` and not later than `to_s`, with the recordings
/// that begin there and the counts of rejected samples of the whole recording.
Recording Between(const Recording& recording, double from_s, double to_s);

/// The part of a recording, `duration_s` long, in which the commands change the most, by the sum of
/// their changes; the whole where it is no longer.
Recording Liveliest(const Recording& recording, double duration_s);

/// The samples of each channel within the last `duration_s` before EndTime, with the same counts.
Recording Latest(const Recording& recording, double duration_s);

}  // namespace telltale
