#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// What acts on a recording besides the model and white sensor noise.
/// Model: gusts and waves accelerate the boat by a stationary first-order Gauss-Markov process per
/// axis (surge, sway, yaw). Units: (m/s^2, m/s^2, rad/s^2) and seconds. Zero sigma: none.
struct Disturbance {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d time_constant_s = Eigen::Vector3d::Ones();
  /// GNSS drift: one sigma of the random walk of fixes within a second, north and east each. It
  /// grows with the root of time. It resembles an acceleration of the boat and is none.
  double gnss_drift_m = 0.0;
};

/// The processes of a disturbance, one an axis, on the streams first_stream to first_stream + 2 of
/// the seed. Requires: step_s > 0.
std::array<GaussMarkov, 3> DrawDisturbances(const Disturbance& disturbance, double step_s,
                                            std::uint64_t seed, std::uint64_t first_stream);

/// A constant disturbance: a part fixed in the body frame and a part fixed in the north-east-down
/// frame, as wind and current are to first order. docs/concepts/model.md (70).
/// Shapes and units: rows surge, sway, yaw (m/s^2, m/s^2, rad/s^2); columns the coefficients of 1,
/// cos psi and sin psi.
struct ConstantDisturbance {
  Eigen::Matrix3d terms = Eigen::Matrix3d::Zero();

  /// The acceleration at a heading.
  NuDot At(double psi_rad) const;
};

}  // namespace telltale
