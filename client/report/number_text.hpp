#pragma once

#include <cstddef>
#include <string>

namespace telltale {

/// `digits` significant digits, zeros at the end kept; "∞" where there is no bound, "–" for NaN.
std::string Significant(double value, int digits = 4);

/// The number with `decimals` decimals, as for times and shares.
std::string Fixed(double value, int decimals);

/// Up to six significant digits and no more zeros than needed, as for numbers a person chose.
std::string Plain(double value);

/// "1 segment", "3 segments".
std::string Counted(std::size_t count, const std::string& one, const std::string& many);

/// "2026-05-01 10:00:00", UTC.
std::string UtcText(double unix_s);

/// A share as "81 %".
std::string ShareText(double share);

}  // namespace telltale
