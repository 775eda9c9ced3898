#pragma once

#include <string>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// "a yaw moment of -2.1 N m at a heading of 45 to 81 deg to 1.4 N m at 225 to 261 deg": the part
/// of a missing force that exceeds the references most and that repeats, or, where none does, how
/// much it scatters.
std::string DescribeMissingForce(const MissingForce& missing);

/// What to record so that an unknown cause of this force shows. One entry, which separates no
/// effects by name.
SeparationAdvice AdviseRecording(const MissingForce& missing);

}  // namespace telltale
