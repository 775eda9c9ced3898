#pragma once

#include <Eigen/Core>

namespace telltale {

/// Pose of the body origin in the local north-east-down frame {n}.
/// Units: metres north, metres east, radians clockwise from north. psi_rad is not wrapped; in a
/// series of poses it has no jumps.
struct Eta {
  double x_m = 0.0;
  double y_m = 0.0;
  double psi_rad = 0.0;
};

/// Velocity over ground in the body frame {b}: surge u (m/s), sway v (m/s, to starboard) and yaw
/// rate r (rad/s, to starboard).
struct Nu {
  double u = 0.0;
  double v = 0.0;
  double r = 0.0;
};

/// Body acceleration: (m/s^2, m/s^2, rad/s^2).
struct NuDot {
  double u = 0.0;
  double v = 0.0;
  double r = 0.0;
};

/// The rate of the pose, eta_dot = R(psi) nu, docs/concepts/model.md (2).
Eigen::Vector3d EtaDot(double psi_rad, const Nu& nu);

/// Smallest signed angle congruent to `angle_rad`, in [-pi, pi).
double WrapAngle(double angle_rad);

}  // namespace telltale
