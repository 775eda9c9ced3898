#pragma once

#include <vector>

namespace telltale {

/// The middle of the sorted values, the upper one of two. Requires: at least one value.
double Median(std::vector<double> values);

}  // namespace telltale
