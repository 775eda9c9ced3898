#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// The equations of motion, one per body velocity.
enum class Equation { kUnknown, kSurge, kSway, kYaw };

inline constexpr std::array kEquations = {Equation::kSurge, Equation::kSway, Equation::kYaw};

/// The index of an equation in arrays ordered surge, sway, yaw. Requires: a named equation.
std::size_t IndexOf(Equation equation);

/// The velocity that an equation predicts: u, v or r.
double ComponentOf(const Nu& nu, Equation equation);

/// "SURGE", "SWAY" or "YAW".
std::string_view Name(Equation equation);

}  // namespace telltale
