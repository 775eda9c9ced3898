#pragma once

#include <array>
#include <cmath>

#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// The body part of the rows Phi_j(nu, .), docs/concepts/model.md (10)..(12), in the order of
/// Regressors(): the row of surge, and the row that sway and yaw share.
struct BodyRow {
  std::array<double, 5> surge;
  std::array<double, 9> turning;
};

inline BodyRow BodyRowAt(const Nu& nu) {
  const double v_abs = std::abs(nu.v);
  const double r_abs = std::abs(nu.r);
  return {{nu.u * std::abs(nu.u), nu.v * nu.r, nu.r * nu.r, nu.u, 1.0},
          {nu.v * v_abs, nu.v * r_abs, nu.r * v_abs, nu.r * r_abs, nu.u * nu.v, nu.u * nu.r, nu.v,
           nu.r, 1.0}};
}

/// BodyRowAt measured velocities, corrected for the bias that their noise gives the nonlinear
/// regressors |x| and x |x| (E |x + e| > |x|). Instruments do not remove this bias.
/// Model: 2 Phi(nu) - E Phi(nu + e). Its mean over measured velocities is Phi of the true velocity
/// to first order in the bias.
/// Assumes: errors of u, v and r are normal and independent, with the standard deviations `noise`.
BodyRow NoiseCorrectedBodyRow(const Nu& nu, const Nu& noise);

}  // namespace telltale
