#pragma once

#include <string>

namespace telltale {

/// The fewest digits that read back to the same bits.
std::string ShortestNumber(double value);

}  // namespace telltale
