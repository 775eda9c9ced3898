#pragma once

#include <string>
#include <string_view>

#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// A regressor in words: "forward thrust, linear" for "f:d". In surge "u" is its "damping, linear",
/// elsewhere it is "surge, linear". Empty for a name that is no regressor.
std::string_view RegressorInWords(Equation equation, std::string_view regressor);

/// Symbol and words in one cell: "f:d   forward thrust, linear".
std::string RegressorCell(Equation equation, std::string_view regressor);

/// The same of a parameter of the physical form: "m22   mass in sway".
std::string ParameterCell(std::string_view symbol);

}  // namespace telltale
