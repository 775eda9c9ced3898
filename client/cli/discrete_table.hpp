#pragma once

#include <string>

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// The coefficients times the sampling period, as the paper's tables hold them, and alpha.
std::string DiscreteTable(const Identification& identification);

}  // namespace telltale
