#pragma once

#include <span>
#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// A heading in radians, less than half a turn from the last of those unwrapped before it; as
/// reported where there is none.
double UnwrappedBehind(const std::vector<double>& psi_rad, double heading_deg);

/// Headings in radians without jumps at north: each differs from its predecessor by less than half
/// a turn; the first is as reported. Assumes: less than half a turn between samples.
std::vector<double> Unwrap(std::span<const HeadingSample> samples);

}  // namespace telltale
