#pragma once

#include <numbers>

namespace blind::truth {

inline constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace blind::truth
