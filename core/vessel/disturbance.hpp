#pragma once

#include <Eigen/Core>

namespace telltale {

/// What else accelerates a boat, wind gusts and waves: per axis a stationary first-order
/// Gauss-Markov process. Units: (m/s^2, m/s^2, rad/s^2) and seconds. Zero sigma: none.
struct Disturbance {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d time_constant_s = Eigen::Vector3d::Ones();
};

}  // namespace telltale
