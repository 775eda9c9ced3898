#pragma once

#include <vector>

#include "telltale/client/exchange/input_gains.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// What commands come to, by the values that simulations use.
struct ModelGains {
  Identification model;  ///< with those values
  std::vector<CommandGain> gains;
};

/// Without commands: full ahead, half ahead, a turn to either side, FR and RF.
/// Requires: commands in [-1, 1].
ModelGains GainsOf(const Identification& model, std::vector<PropellerCommand> commands);

}  // namespace telltale
