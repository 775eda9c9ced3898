#pragma once

#include <Eigen/Core>

namespace telltale {

/// Process and sensor noise. All > 0.
/// Model: accelerations of the boat and the error of the fixes are first-order Gauss-Markov
/// processes beside white sensor noise; the stamp of a fix is off by white noise.
struct NoiseModel {
  Eigen::Vector3d acceleration_sigma{0.1, 0.1, 0.1};  ///< m/s^2, m/s^2, rad/s^2, stationary
  double acceleration_time_constant_s = 2.0;
  double fix_drift_sigma_m = 0.1;
  double fix_sigma_m = 0.05;
  double heading_sigma_rad = 0.01;
  double stamp_sigma_s = 0.02;

  static constexpr double kFixDriftTimeConstantS = 20.0;
};

}  // namespace telltale
