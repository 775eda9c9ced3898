#pragma once

#include <optional>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The recording without the fixes and headings that only repeat the one before, counted as
/// RejectReason::kRepeated; nothing where no channel has such. A log that writes more often than
/// its sensor measures holds the last reading until the next: its runs of equal readings are even.
/// A coarse compass repeats itself too, for long on a straight course and hardly in a turn; its
/// readings stay. Assumption: a channel repeats a tenth of its readings or more, and nineteen of
/// twenty readings stand in runs of the median length or of one reading more or less.
std::optional<Recording> WithoutRepeatedReadings(const Recording& recording);

}  // namespace telltale
