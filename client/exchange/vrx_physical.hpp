#pragma once

#include <string>

#include "telltale/core/identification/physical_model.hpp"

namespace telltale {

/// The physical form as an SDF fragment for VRX's hydrodynamics plugin: M and D times m11, with m11
/// = mass_kg. Drag in N, N s/m and so on, positive against motion. The added mass in sway is that
/// beyond surge. docs/guides/model-exchange.md.
/// Requires: mass_kg > 0.
std::string PrintPhysicalVrx(const std::string& vehicle_id, const PhysicalModel& model,
                             double mass_kg);

}  // namespace telltale
