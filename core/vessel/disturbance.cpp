#include "telltale/core/vessel/disturbance.hpp"

#include <cmath>

namespace telltale {

std::array<GaussMarkov, 3> DrawDisturbances(const Disturbance& disturbance, double step_s,
                                            std::uint64_t seed, std::uint64_t first_stream) {
  const auto axis = [&](Eigen::Index j) {
    return GaussMarkov(disturbance.sigma[j], disturbance.time_constant_s[j], step_s,
                       WhiteSource(seed, first_stream + static_cast<std::uint64_t>(j)));
  };
  return {axis(0), axis(1), axis(2)};
}

NuDot ConstantDisturbance::At(double psi_rad) const {
  Eigen::Vector3d rate = terms.col(0);
  const auto to_north_and_east = terms.rightCols<2>();
  if (!to_north_and_east.isZero(0.0)) {
    rate += to_north_and_east * Eigen::Vector2d(std::cos(psi_rad), std::sin(psi_rad));
  }
  return {rate[0], rate[1], rate[2]};
}

}  // namespace telltale
