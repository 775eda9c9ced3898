#pragma once

#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/check/recorded_motion.hpp"

namespace telltale {

/// Headings that are off by a constant angle, over headings all around; method in motion_check.hpp.
/// None in most recordings.
std::optional<Refusal> ConstantAngle(const RecordedMotion& motion);

}  // namespace telltale
