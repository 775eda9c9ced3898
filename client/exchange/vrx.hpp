#pragma once

#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The model as an SDF fragment for VRX's hydrodynamics plugin (vrx::SimpleHydrodynamics; the
/// elements are those of the classic usv_gazebo_dynamics_plugin too), whose drags are in newtons
/// and so need an inertia. Model: m11 = m22 = mass_kg; yaw inertia m11 (d/2) G_u / G_r, with G the
/// input gain of the port propeller alone at full forward command; drag = -inertia times
/// coefficient. docs/guides/model-exchange.md. Refuses when: the vehicle file states no mass, an
/// equation is missing, or the thrust of one propeller is not known in surge and in yaw.
Result<std::string> PrintVrx(const Identification& identification, const Vehicle& vehicle);

}  // namespace telltale
