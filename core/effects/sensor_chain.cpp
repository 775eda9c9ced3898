#include "telltale/core/effects/sensor_chain.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {

Eigen::Vector2d Turned(double psi_rad, double forward, double starboard) {
  const double c = std::cos(psi_rad);
  const double s = std::sin(psi_rad);
  return {c * forward - s * starboard, s * forward + c * starboard};
}

Pose MeasuredAt(const PreparedDataset& dataset, const RowRange& segment, double time_s) {
  const PreparedRow& first = dataset.rows[segment.begin];
  const double steps = std::clamp((time_s - first.time_s) / dataset.sampling_period_s, 0.0,
                                  static_cast<double>(segment.size() - 1));
  const std::size_t k = std::min(static_cast<std::size_t>(steps), segment.size() - 2);
  const double share = steps - static_cast<double>(k);
  const PreparedRow& a = dataset.rows[segment.begin + k];
  const PreparedRow& b = dataset.rows[segment.begin + k + 1];
  const auto between = [&](double x, double y) { return x + share * (y - x); };
  return {{between(a.eta.x_m, b.eta.x_m), between(a.eta.y_m, b.eta.y_m),
           between(a.eta.psi_rad, b.eta.psi_rad)},
          {between(a.nu.u, b.nu.u), between(a.nu.v, b.nu.v), between(a.nu.r, b.nu.r)}};
}

Pose TrueStart(const PreparedDataset& dataset, const RowRange& segment, double time_s,
               const AugmentedBoat& boat) {
  const Pose now = MeasuredAt(dataset, segment, time_s);
  const Pose fixed = MeasuredAt(dataset, segment, time_s + boat.LatencyS());
  const LeverArm stated = dataset.sensors.antenna;
  const LeverArm shift = boat.AntennaShift();
  const double ahead = stated.forward_m + shift.forward_m;
  const double aside = stated.starboard_m + shift.starboard_m;
  const double psi = boat.TrueHeadingRad(now.eta.psi_rad);
  const double r = now.nu.r / boat.MeasuredHeadingSlope(psi);
  const double psi_fixed = fixed.eta.psi_rad;
  const Eigen::Vector2d antenna = Eigen::Vector2d(fixed.eta.x_m, fixed.eta.y_m) +
                                  Turned(psi_fixed, stated.forward_m, stated.starboard_m);
  const Eigen::Vector2d antenna_velocity =
      Turned(psi_fixed, fixed.nu.u - fixed.nu.r * stated.starboard_m,
             fixed.nu.v + fixed.nu.r * stated.forward_m);
  const Eigen::Vector2d position = antenna - Turned(psi, ahead, aside);
  const Eigen::Vector2d velocity = antenna_velocity - r * Turned(psi, -aside, ahead);
  return {{position[0], position[1], psi},
          {std::cos(psi) * velocity[0] + std::sin(psi) * velocity[1],
           -std::sin(psi) * velocity[0] + std::cos(psi) * velocity[1], r}};
}

Pose MeasuredPose(const Pose& now, const Pose& past, const LeverArm& stated,
                  const AugmentedBoat& boat) {
  const LeverArm shift = boat.AntennaShift();
  const double ahead = stated.forward_m + shift.forward_m;
  const double aside = stated.starboard_m + shift.starboard_m;
  const Nu& nu = past.nu;
  const Eigen::Vector2d antenna =
      Eigen::Vector2d(past.eta.x_m, past.eta.y_m) + Turned(past.eta.psi_rad, ahead, aside);
  const Eigen::Vector2d antenna_velocity =
      Turned(past.eta.psi_rad, nu.u - nu.r * aside, nu.v + nu.r * ahead);
  const double psi = boat.MeasuredHeadingRad(now.eta.psi_rad);
  const double r = now.nu.r * boat.MeasuredHeadingSlope(now.eta.psi_rad);
  const Eigen::Vector2d position = antenna - Turned(psi, stated.forward_m, stated.starboard_m);
  const Eigen::Vector2d velocity =
      antenna_velocity - r * Turned(psi, -stated.starboard_m, stated.forward_m);
  return {{position[0], position[1], psi},
          {std::cos(psi) * velocity[0] + std::sin(psi) * velocity[1],
           -std::sin(psi) * velocity[0] + std::cos(psi) * velocity[1], r}};
}

}  // namespace telltale
