#include "coverage/hulls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale::coverage {
namespace {

double Signed(double x, double power) {
  return x >= 0.0 ? std::pow(x, power) : -std::pow(-x, power);
}

// Cross-flow drag of slender strips along the hull: sway force and yaw moment.
// Source: Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2nd ed., 6.4.3.
Eigen::Vector3d CrossFlowDrag(const Eigen::Vector3d& nu, double length_m, double draught_m,
                              double coefficient) {
  constexpr int kStrips = 20;
  constexpr double kDensity = 1025.0;
  const double dx = length_m / kStrips;
  Eigen::Vector3d drag = Eigen::Vector3d::Zero();
  for (int i = 0; i < kStrips; ++i) {
    const double x = -0.5 * length_m + (i + 0.5) * dx;
    const double cross = nu[1] + x * nu[2];
    const double force = 0.5 * kDensity * draught_m * coefficient * std::abs(cross) * cross * dx;
    drag[1] += force;
    drag[2] += x * force;
  }
  return drag;
}

// Bench thrust of a T200 at 12 V in newtons: the fits give the pulse width of a thrust in kgf.
double T200(double delta) {
  constexpr double kNewtonsPerKgf = 9.80665;
  const double pulse_us = 1500.0 + 400.0 * delta;
  if (pulse_us > 1464.0 && pulse_us < 1540.0) return 0.0;
  const auto pulse_of = [](double kgf) {
    return kgf >= 0.0 ? ((3.771 * kgf - 31.19) * kgf + 159.9) * kgf + 1540.0
                      : ((7.359 * kgf + 47.59) * kgf + 199.2) * kgf + 1461.0;
  };
  double low = delta > 0.0 ? 0.0 : -4.0;
  double high = delta > 0.0 ? 5.0 : 0.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (pulse_of(middle) < pulse_us ? low : high) = middle;
  }
  return kNewtonsPerKgf * 0.5 * (low + high);
}

}  // namespace

Eigen::Vector3d Hull::Acceleration(const Eigen::Vector3d& nu, double port_n, double starboard_n,
                                   const Eigen::Vector3d& disturbance) const {
  Eigen::Matrix3d mass;
  mass << m11, 0.0, 0.0, 0.0, m22, m23, 0.0, m23, m33;
  const double momentum = m22 * nu[1] + m23 * nu[2];
  const Eigen::Vector3d coriolis(-momentum * nu[2], m11 * nu[0] * nu[2],
                                 momentum * nu[0] - m11 * nu[0] * nu[1]);
  const Eigen::Vector3d tau(port_n + starboard_n, 0.0,
                            0.5 * propeller_separation_m * (port_n - starboard_n));
  return mass.inverse() * (tau - coriolis - drag(nu)) + disturbance;
}

Hull OfTheForm() {
  Hull hull;
  hull.name = "form";
  hull.length_m = 1.4;
  hull.propeller_separation_m = 0.7;
  hull.m11 = 30.0;
  hull.m22 = 48.0;
  hull.m23 = 1.5;
  hull.m33 = 6.5;
  hull.drag = [](const Eigen::Vector3d& nu) {
    const auto [u, v, r] = std::array{nu[0], nu[1], nu[2]};
    return Eigen::Vector3d((6.0 + 13.0 * std::abs(u)) * u,
                           (25.0 + 40.0 * std::abs(v) + 9.0 * u) * v + (2.0 + 3.0 * u) * r,
                           (1.5 + 4.0 * u) * v + (5.0 + 4.0 * std::abs(r) + 2.0 * u) * r);
  };
  hull.thrust = [](double delta) {
    const double beyond = std::max(std::abs(delta) - kDeadBandOfTheForm, 0.0);
    return delta >= 0.0 ? (12.0 + 30.0 * beyond) * beyond : -(10.0 + 22.0 * beyond) * beyond;
  };
  hull.imbalance = 0.05;
  hull.thrust_time_constant_s = 0.2;
  return hull;
}

Hull Otter() {
  Hull hull;
  hull.name = "otter";
  hull.length_m = 2.0;
  hull.propeller_separation_m = 0.79;
  hull.m11 = 85.5;
  hull.m22 = 162.5;
  hull.m23 = 3.0;
  hull.m33 = 41.0;
  const double yaw_per_s = hull.m33;
  hull.drag = [yaw_per_s](const Eigen::Vector3d& nu) {
    const Eigen::Vector3d linear(77.5 * nu[0], 0.0,
                                 yaw_per_s * (1.0 + 10.0 * std::abs(nu[2])) * nu[2]);
    return Eigen::Vector3d(linear + CrossFlowDrag(nu, 2.0, 0.195, 0.75));
  };
  hull.thrust = [](double delta) { return (delta >= 0.0 ? 119.7 : 66.7) * Signed(delta, 2.0); };
  return hull;
}

Hull CyberShip() {
  Hull hull;
  hull.name = "cybership";
  hull.length_m = 1.255;
  hull.propeller_separation_m = 0.15;
  hull.m11 = 25.8;
  hull.m22 = 33.8;
  hull.m23 = 1.0948;
  hull.m33 = 2.76;
  hull.drag = [](const Eigen::Vector3d& nu) {
    const auto [u, v, r] = std::array{nu[0], nu[1], nu[2]};
    const double av = std::abs(v);
    const double ar = std::abs(r);
    return Eigen::Vector3d(
        0.72253 * u + 1.32742 * std::abs(u) * u + 5.86643 * u * u * u,
        (0.88965 + 36.47287 * av + 0.805 * ar) * v + (7.25 + 0.845 * av + 3.45 * ar) * r,
        (-0.0313 - 3.95645 * av - 0.13 * ar) * v + (1.9 - 0.08 * av + 0.75 * ar) * r);
  };
  hull.thrust = [](double delta) { return (delta >= 0.0 ? 2.0 : 1.5) * Signed(delta, 2.0); };
  return hull;
}

Hull WamV() {
  Hull hull;
  hull.name = "wam-v";
  hull.length_m = 4.9;
  hull.propeller_separation_m = 2.06;
  hull.m11 = hull.m22 = 180.0;
  hull.m33 = 446.0;
  hull.drag = [](const Eigen::Vector3d& nu) {
    return Eigen::Vector3d((51.3 + 72.4 * std::abs(nu[0])) * nu[0], 40.0 * nu[1], 400.0 * nu[2]);
  };
  hull.thrust = [](double delta) { return (delta >= 0.0 ? 250.0 : 100.0) * delta; };
  return hull;
}

Hull Catamaran() {
  Hull hull;
  hull.name = "catamaran";
  hull.length_m = 1.2;
  hull.propeller_separation_m = 0.6;
  hull.m11 = 18.5;
  hull.m22 = 29.0;
  hull.m23 = 0.6;
  hull.m33 = 2.8;
  hull.drag = [](const Eigen::Vector3d& nu) {
    const Eigen::Vector3d linear(4.0 * nu[0] + 9.0 * std::abs(nu[0]) * nu[0], 12.0 * nu[1],
                                 2.5 * nu[2]);
    return Eigen::Vector3d(linear + CrossFlowDrag(nu, 1.2, 0.15, 0.9));
  };
  hull.thrust = T200;
  hull.thrust_time_constant_s = 0.15;
  return hull;
}

Vehicle VehicleOf(const Hull& hull) {
  Vehicle vehicle;
  vehicle.vehicle_id = hull.name;
  vehicle.propeller_separation_m = hull.propeller_separation_m;
  vehicle.gnss_antenna = {-0.2, 0.1};
  HullParticulars particulars;
  particulars.length_m = hull.length_m;
  vehicle.hull = particulars;
  return vehicle;
}

}  // namespace telltale::coverage
