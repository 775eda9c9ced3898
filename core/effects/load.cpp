#include "telltale/core/effects/load.hpp"

#include <algorithm>

namespace telltale {

NuDot LoadedLess(const NuDot& light, const Load& load, const InstantState& instant) {
  const auto [p, x, a] = load;
  const Nu& nu = instant.nu;
  const Nu& nu_r = instant.nu_r;
  const HullScale& hull = instant.hull_scale;
  const double inertia = hull.yaw_inertia * hull.gyration_radius_m * hull.gyration_radius_m;
  const double carried = a * (hull.sway_mass - 1.0);  // over the boat's mass
  const double p_v = p / hull.sway_mass;
  const double p_r = p * x / inertia;
  const double sway_inertia = 1.0 + p_v + carried / hull.sway_mass;
  const double yaw_inertia = 1.0 + p_r * x + a * (1.0 - 1.0 / hull.yaw_inertia);
  const double surge = light.u + p * (nu.v * nu.r + x * nu.r * nu.r) + carried * nu_r.v * nu.r;
  const double side = light.v - p_v * nu.u * nu.r;
  const double turn = light.r - p_r * nu.u * nu.r - carried / inertia * nu_r.u * nu_r.v;
  const double determinant = std::max(sway_inertia * yaw_inertia - p_v * x * p_r, 0.1);
  return {surge / (1.0 + p) - light.u,
          (yaw_inertia * side - p_v * x * turn) / determinant - light.v,
          (sway_inertia * turn - p_r * side) / determinant - light.r};
}

}  // namespace telltale
