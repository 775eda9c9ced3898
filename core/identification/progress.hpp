#pragma once

#include <functional>
#include <string_view>

namespace telltale {

/// Called as a computation advances: the stage it is in, and the fraction done, in [0, 1].
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Progress of a part of a computation: its fractions are mapped to [from, to]. Empty where
/// `progress` is. Requires: `progress` outlives the result.
Progress ProgressWithin(const Progress& progress, double from, double to);

}  // namespace telltale
