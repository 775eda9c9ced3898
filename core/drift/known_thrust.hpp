#pragma once

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// Whether what either thruster gives at full command ahead, in surge and in yaw, is larger than
/// its standard error. Coefficients of a model of which it is not may make up for each other over
/// its own recording and err over any other as if the boat had changed.
bool KnowsThrust(const Identification& identification);

}  // namespace telltale
