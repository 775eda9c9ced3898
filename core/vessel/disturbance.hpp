#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// What a recording shows besides model and white noise. What else accelerates the boat, wind gusts
/// and waves: per axis a stationary first-order Gauss-Markov process. Units: (m/s^2, m/s^2,
/// rad/s^2) and seconds. Zero sigma: none.
struct Disturbance {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d time_constant_s = Eigen::Vector3d::Ones();
  /// One sigma of what fixes wander off by within a second, north and east each; it grows with the
  /// root of time. Seems to accelerate the boat, does not.
  double gnss_drift_m = 0.0;
};

/// Draws of a disturbance, one process an axis: streams first_stream to first_stream + 2 of the
/// seed. Requires: step_s > 0.
std::array<GaussMarkov, 3> DrawDisturbances(const Disturbance& disturbance, double step_s,
                                            std::uint64_t seed, std::uint64_t first_stream);

/// What accelerates a boat steadily: a part that turns with the boat and a part that stands in the
/// north-east-down frame, as wind and current do to first order. docs/concepts/model.md (70).
/// Shapes and units: rows surge, sway, yaw (m/s^2, m/s^2, rad/s^2); columns the coefficients of 1,
/// cos psi and sin psi.
struct ConstantDisturbance {
  Eigen::Matrix3d terms = Eigen::Matrix3d::Zero();

  NuDot At(double psi_rad) const;
};

}  // namespace telltale
