#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/vessel/vehicle.hpp"

namespace telltale::coverage {

/// A boat in Fossen's form with forces that the identified form has not.
/// Units: SI; velocities through the water, forces and moments about the body origin.
struct Hull {
  std::string name;
  double length_m = 0.0;
  double propeller_separation_m = 0.0;
  double m11 = 0.0;
  double m22 = 0.0;
  double m23 = 0.0;
  double m33 = 0.0;
  std::function<Eigen::Vector3d(const Eigen::Vector3d& nu)> drag;  ///< opposes the motion
  std::function<double(double delta)> thrust;                      ///< of one propeller, N
  double imbalance = 0.0;  ///< port gives 1 - imbalance of that thrust, starboard 1 + imbalance
  double thrust_time_constant_s = 0.1;

  /// nu_dot under thrusts in newtons and an acceleration from outside.
  Eigen::Vector3d Acceleration(const Eigen::Vector3d& nu, double port_n, double starboard_n,
                               const Eigen::Vector3d& disturbance) const;
};

inline constexpr double kDeadBandOfTheForm = 0.05;

/// A boat of the identified form: its parameters are the truth.
Hull OfTheForm();

/// Maritime Robotics' Otter with a load of 25 kg: linear surge drag, yaw drag, and cross-flow drag
/// by strips; thrust by the square of the shaft speed. Source: Fossen, Python Vehicle Simulator,
/// vehicles/otter.
Hull Otter();

/// The model ship CyberShip II with two propellers: drag in |v| r, |r| v, |r| r and |v| v. Source:
/// Skjetne, Smogeli and Fossen, "A Nonlinear Ship Manoeuvering Model: Identification and Adaptive
/// Control with Experiments for a Model Ship", MIC 25 (2004).
Hull CyberShip();

/// The WAM-V of the Virtual RobotX simulator: linear drag except in surge; thrust linear in the
/// command. Source: VRX, wamv_gazebo, dynamics plugin.
Hull WamV();

/// A catamaran of 1.2 m with two T200 thrusters and cross-flow drag.
/// Source of the thrust: cubic fits of the manufacturer's bench data at 12 V.
Hull Catamaran();

/// As the operator of the hull states it.
Vehicle VehicleOf(const Hull& hull);

}  // namespace telltale::coverage
