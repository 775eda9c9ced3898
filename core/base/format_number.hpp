#pragma once

#include <string>

namespace telltale {

/// "0.35", with so many decimals.
std::string Number(double value, int decimals);

}  // namespace telltale
