#include "vessel/disturbance.hpp"

#include <cmath>

namespace telltale {

NuDot SteadyDisturbance::At(double psi_rad) const {
  const Eigen::Vector3d rate = terms * Eigen::Vector3d(1.0, std::cos(psi_rad), std::sin(psi_rad));
  return {rate[0], rate[1], rate[2]};
}

}  // namespace telltale
