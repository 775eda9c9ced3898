#pragma once

#include <string>

namespace telltale {

/// The fewest digits that read back to the same bits.
std::string Shortest(double value);

}  // namespace telltale
