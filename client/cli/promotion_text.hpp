#pragma once

#include <string>

#include "telltale/core/validation/promotion.hpp"

namespace telltale {

/// "verdict WARN: why", wrapped for a terminal; empty where there is no verdict.
std::string PromotionText(const Promotion& promotion);

}  // namespace telltale
