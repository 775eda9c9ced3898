#pragma once

#include <string_view>

#include "telltale/core/vessel/equation.hpp"

namespace telltale {

/// Thrust follows the command at once, or through a first-order lag.
enum class Structure { kUnknown, kStaticQuadratic, kFirstOrderDynamic };

/// The form of the propeller regressors. kPaper takes the paper's mean and difference; kPropeller
/// sums over the two propellers and is consistent in all four regions.
enum class Parameterization { kUnknown, kPropeller, kPaper };

std::string_view Name(Structure structure);
std::string_view Name(Parameterization parameterization);

}  // namespace telltale
