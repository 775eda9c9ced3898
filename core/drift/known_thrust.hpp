#pragma once

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// Whether the 95 % bounds of what either thruster gives at full command ahead, in surge and in
/// yaw, leave out zero. Coefficients of a model whose bounds do not may make up for each other over
/// its own recording and err over any other as if the boat had changed.
bool KnowsThrust(const Identification& identification);

}  // namespace telltale
