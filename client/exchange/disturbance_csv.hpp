#pragma once

#include <span>
#include <string>

#include "telltale/core/identification/input_gain.hpp"

namespace telltale {

/// The lumped disturbance as comma-separated values under the header
/// time_s,sigma_u,sigma_v,sigma_r: seconds, m/s^2, m/s^2, rad/s^2. Numbers read back to the same
/// bits.
std::string PrintDisturbanceCsv(std::span<const DisturbanceSample> samples);

}  // namespace telltale
