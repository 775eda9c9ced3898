#pragma once

#include <string>

#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale::testing {

/// A boat that may announce itself; with another mass it has other particulars.
inline Vehicle Boat(const std::string& vehicle_id, double mass_kg = 20.0) {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.vehicle_id = vehicle_id;
  vehicle.mass_kg = mass_kg;
  return vehicle;
}

}  // namespace telltale::testing
