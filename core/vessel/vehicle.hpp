#pragma once

#include <optional>
#include <string>

#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// Where the GNSS antenna sits, from the body origin. Units: metres.
struct LeverArm {
  double forward_m = 0.0;
  double starboard_m = 0.0;
};

/// What an operator states about one boat: identity, geometry and thruster channels.
struct Vehicle {
  std::string vehicle_id;
  double propeller_separation_m = 0.0;
  PwmChannel port;
  PwmChannel starboard;
  LeverArm gnss_antenna;
  std::optional<double> mass_kg;

  PropellerCommand Normalise(double port_us, double starboard_us) const {
    return {port.Normalise(port_us), starboard.Normalise(starboard_us)};
  }
};

}  // namespace telltale
