#pragma once

#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/check/recorded_motion.hpp"

namespace telltale {

/// The fault of headings, positions or thrusters without which the commands explain the motion far
/// better than with it; method in motion_check.hpp. None in most recordings.
std::optional<Refusal> LikeliestSupposedFault(const RecordedMotion& motion);

}  // namespace telltale
