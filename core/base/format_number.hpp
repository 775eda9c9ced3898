#pragma once

#include <string>

namespace telltale {

/// The value with `decimals` digits after the point: 0.35 with two is "0.35".
std::string FormatNumber(double value, int decimals);

/// The value with at most `digits` significant digits, as printf's %g writes it.
std::string FormatSignificant(double value, int digits);

}  // namespace telltale
