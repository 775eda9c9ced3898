#pragma once

#include <string_view>

namespace blind::score {

/// Whether two effects are known to look alike, whichever of them is there: most of what either
/// does to a boat the other does too. By the physics of the pair, not by any report.
bool AreConfusable(std::string_view one, std::string_view other);

}  // namespace blind::score
