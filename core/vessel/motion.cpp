#include "telltale/core/vessel/motion.hpp"

#include <cmath>
#include <numbers>

namespace telltale {

Eigen::Vector3d EtaDot(double psi_rad, const Nu& nu) {
  const double c = std::cos(psi_rad);
  const double s = std::sin(psi_rad);
  return {c * nu.u - s * nu.v, s * nu.u + c * nu.v, nu.r};
}

double WrapAngle(double angle_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle_rad - kTurn * std::floor((angle_rad + std::numbers::pi) / kTurn);
}

}  // namespace telltale
