#pragma once

#include <optional>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/check/recorded_motion.hpp"

namespace telltale {

/// The first channel that keeps to one value while the others say that it should not: thrusters,
/// headings, then positions. None in most recordings. Requires: two samples of each channel, those
/// of which the motion is.
std::optional<Refusal> StuckChannel(const std::vector<GnssFix>& gnss,
                                    const std::vector<HeadingSample>& heading,
                                    const std::vector<ThrusterSample>& thrusters,
                                    const RecordedMotion& motion);

}  // namespace telltale
