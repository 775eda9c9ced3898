#pragma once

#include <string_view>

#include "telltale/core/vessel/equation.hpp"

namespace telltale {

/// kStaticQuadratic and kFirstOrderDynamic, the paper's: free coefficients, and thrust that follows
/// the command at once or through a first-order lag. kFossen: the parameters of FossenParameter,
/// with a lag, and the coefficients that they imply.
enum class Structure { kUnknown, kStaticQuadratic, kFirstOrderDynamic, kFossen };

/// Whether thrust follows the command through a lag.
constexpr bool HasLag(Structure structure) {
  return structure == Structure::kFirstOrderDynamic || structure == Structure::kFossen;
}

/// The form of the propeller regressors. kPaper takes the paper's mean and difference; kPropeller
/// sums over the two propellers and is consistent in all four regions.
enum class Parameterization { kUnknown, kPropeller, kPaper };

std::string_view Name(Structure structure);
std::string_view Name(Parameterization parameterization);

}  // namespace telltale
