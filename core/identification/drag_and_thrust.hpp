#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/identification/physical_model.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {

/// What parameters of the physical form add up to at one speed or command, with bounds.
struct ForceAtPoint {
  std::string name;     ///< "forward thrust"
  double at = 0.0;      ///< a speed, or a share of full command
  std::string at_unit;  ///< of the speed; "1" of a command
  double estimate = 0.0;
  Interval interval;
  std::string unit;
};

/// Drag and thrust at points that every boat has: its top speed, its rate of turn on the spot, half
/// of both, half and full command. A short recording tells the sum of a linear and a quadratic term
/// at such a point much better than either.
/// Model: docs/concepts/physical-model.md (119); the top speed has drag and the thrust of
/// two propellers in balance, the rate of turn on the spot the damping of yaw and their moment with
/// one full ahead and the other full astern. Drag across the hull is that of a tenth of the top
/// speed. Units: forces over the mass with added mass in surge, m/s^2, moments m^2/s^2.
/// Bounds: normal, by the delta method from the covariance of the parameters, at the level of the
/// model's intervals, at least nothing.
std::vector<ForceAtPoint> DragAndThrustOf(const PhysicalModel& physical);

/// The values of other parameters at the same points. Requires: points of DragAndThrustOf().
Eigen::VectorXd ForcesAt(const std::vector<ForceAtPoint>& points, const FossenVector& parameters,
                         double separation_m);

}  // namespace telltale
