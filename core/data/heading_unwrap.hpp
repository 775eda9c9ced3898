#pragma once

#include <span>
#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// Headings in radians without jumps at north: each differs from its predecessor by less than half
/// a turn; the first is as reported. Assumes: less than half a turn between samples.
std::vector<double> Unwrap(std::span<const HeadingSample> samples);

}  // namespace telltale
