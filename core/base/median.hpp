#pragma once

#include <vector>

namespace telltale {

/// The middle of the sorted values; of an even count the upper of the two in the middle.
/// Requires: at least one value.
double Median(std::vector<double> values);

}  // namespace telltale
