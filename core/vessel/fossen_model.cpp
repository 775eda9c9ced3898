#include "telltale/core/vessel/fossen_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

// Of sway and yaw.
Eigen::Matrix2d InverseMass(const FossenVector& p) {
  const double determinant = p[At(kM22)] * p[At(kM33)] - p[At(kM23)] * p[At(kM23)];
  Require(determinant > 0.0, "a positive definite mass matrix");
  Eigen::Matrix2d inverse;
  inverse << p[At(kM33)], -p[At(kM23)], -p[At(kM23)], p[At(kM22)];
  return inverse / determinant;
}

constexpr Eigen::Index kSurgeCoefficients = 9;
constexpr Eigen::Index kTurningCoefficients = 13;
constexpr Eigen::Index kCoefficients = kSurgeCoefficients + 2 * kTurningCoefficients;

}  // namespace

const std::array<FossenParameterName, kFossenParameters>& FossenParameterNames() {
  static const std::array<FossenParameterName, kFossenParameters> names = {{
      {"m22", "1", "mass in sway"},
      {"m23", "m", "coupling of sway and yaw"},
      {"m33", "m^2", "inertia in yaw"},
      {"Xu", "1/s", "drag in surge, linear"},
      {"Xuu", "1/m", "drag in surge, quadratic"},
      {"Yv", "1/s", "drag in sway, linear"},
      {"Yr", "m/s", "sway force of the yaw rate"},
      {"Nv", "m/s", "yaw moment of sway"},
      {"Nr", "m^2/s", "damping in yaw, linear"},
      {"Yvv", "1/m", "drag in sway, quadratic"},
      {"Yrv", "1", "drag in sway while turning"},
      {"Nvv", "1", "yaw moment of sway, quadratic"},
      {"Nvr", "m", "damping in yaw while in sway"},
      {"Nrr", "m^2", "damping in yaw, quadratic"},
      {"Yuv", "1/m", "lift of sway"},
      {"Yur", "1", "lift of the yaw rate"},
      {"Nuv", "1", "moment of lift of sway"},
      {"Nur", "m", "moment of lift of yaw rate"},
      {"Tf1", "m/s^2", "forward thrust, linear"},
      {"Tf2", "m/s^2", "forward thrust, quadratic"},
      {"Tr1", "m/s^2", "reverse thrust, linear"},
      {"Tr2", "m/s^2", "reverse thrust, quadratic"},
      {"Tru", "s/m", "loss of reverse thrust"},
      {"Tps", "1", "excess of starboard thrust"},
      {"df", "1", "dead band ahead"},
      {"dr", "1", "dead band in reverse"},
      {"tau", "s", "time constant of thrust"},
      {"delay_commands", "s", "behind headings"},
      {"delay_fixes", "s", "behind headings"},
  }};
  return names;
}

FossenDynamics::FossenDynamics(const FossenVector& parameters, double propeller_separation_m)
    : p_(parameters),
      ahead_(p_[telltale::At(kForwardLinear)], p_[telltale::At(kForwardQuadratic)], 0.0, 0.0),
      reverse_(0.0, 0.0, p_[telltale::At(kReverseLinear)], -p_[telltale::At(kReverseQuadratic)]),
      reverse_loss_(ReverseLossOf(parameters)),
      half_separation_m_(0.5 * propeller_separation_m),
      inverse_mass_(InverseMass(parameters)) {}

FossenDynamics::Evaluation FossenDynamics::At(const Eigen::Vector3d& nu, const Thrusts& port,
                                              const Thrusts& starboard) const {
  const auto p = [this](FossenParameter parameter) { return p_[telltale::At(parameter)]; };
  const double u = nu[0];
  const double v = nu[1];
  const double r = nu[2];
  const Eigen::Vector3d thrust = ByThrust(u, port, starboard);
  Evaluation at;
  at.nu_dot[0] = p(kM22) * v * r + p(kM23) * r * r - (p(kXu) + p(kXuu) * std::abs(u)) * u;
  const double sway = -u * r -
                      (p(kYv) + p(kYvv) * std::abs(v) + p(kYrv) * std::abs(r) + p(kYuv) * u) * v -
                      (p(kYr) + p(kYur) * u) * r;
  const double yaw = -(p(kM22) - 1.0 + p(kNuv)) * u * v - (p(kM23) + p(kNur)) * u * r -
                     (p(kNv) + p(kNvv) * std::abs(v)) * v -
                     (p(kNr) + p(kNvr) * std::abs(v) + p(kNrr) * std::abs(r)) * r;
  at.nu_dot.tail<2>() = inverse_mass_ * Eigen::Vector2d(sway, yaw);
  at.nu_dot += thrust;
  at.by_nu.row(0) << -p(kXu) - 2.0 * p(kXuu) * std::abs(u), p(kM22) * r,
      p(kM22) * v + 2.0 * p(kM23) * r;
  Eigen::Matrix<double, 2, 3> force;
  force.row(0) << -r - p(kYuv) * v - p(kYur) * r,
      -p(kYv) - 2.0 * p(kYvv) * std::abs(v) - p(kYrv) * std::abs(r) - p(kYuv) * u,
      -u - p(kYr) - p(kYur) * u - p(kYrv) * std::copysign(v, r * v);
  force.row(1) << -(p(kM22) - 1.0 + p(kNuv)) * v - (p(kM23) + p(kNur)) * r,
      -(p(kM22) - 1.0 + p(kNuv)) * u - p(kNv) - 2.0 * p(kNvv) * std::abs(v) -
          p(kNvr) * std::copysign(r, r * v),
      -(p(kM23) + p(kNur)) * u - p(kNr) - p(kNvr) * std::abs(v) - 2.0 * p(kNrr) * std::abs(r);
  at.by_nu.bottomRows<2>() = inverse_mass_ * force;
  const double share_by_u = reverse_loss_.ByU(u);
  at.by_nu.col(0) +=
      Propelled(share_by_u * reverse_.dot(port), share_by_u * reverse_.dot(starboard));
  return at;
}

Eigen::Vector3d FossenDynamics::ByThrust(double u, const Thrusts& port,
                                         const Thrusts& starboard) const {
  const Thrusts curve = ahead_ + reverse_loss_.Share(u) * reverse_;
  return Propelled(curve.dot(port), curve.dot(starboard));
}

// Of the thrust that each propeller would give without imbalance.
Eigen::Vector3d FossenDynamics::Propelled(double port, double starboard) const {
  Eigen::Vector3d nu_dot;
  const double imbalance = p_[telltale::At(kImbalance)];
  port *= 1.0 - imbalance;
  starboard *= 1.0 + imbalance;
  nu_dot[0] = port + starboard;
  nu_dot.tail<2>() = inverse_mass_.col(1) * (half_separation_m_ * (port - starboard));
  return nu_dot;
}

Eigen::Matrix<double, 3, kForceParameters> FossenDynamics::ByParameter(
    const Eigen::Vector3d& nu, const Eigen::Vector3d& nu_dot, const Thrusts& port,
    const Thrusts& starboard) const {
  const double u = nu[0];
  const double v = nu[1];
  const double r = nu[2];
  Eigen::Matrix<double, 3, kForceParameters> by =
      Eigen::Matrix<double, 3, kForceParameters>::Zero();
  const auto set = [&by](FossenParameter parameter, double surge, double sway, double yaw) {
    by.col(telltale::At(parameter)) << surge, sway, yaw;
  };
  set(kM22, v * r, -nu_dot[1], -u * v);
  set(kM23, r * r, -nu_dot[2], -u * r - nu_dot[1]);
  set(kM33, 0.0, 0.0, -nu_dot[2]);
  set(kXu, -u, 0.0, 0.0);
  set(kXuu, -u * std::abs(u), 0.0, 0.0);
  set(kYv, 0.0, -v, 0.0);
  set(kYr, 0.0, -r, 0.0);
  set(kNv, 0.0, 0.0, -v);
  set(kNr, 0.0, 0.0, -r);
  set(kYvv, 0.0, -v * std::abs(v), 0.0);
  set(kYrv, 0.0, -std::abs(r) * v, 0.0);
  set(kNvv, 0.0, 0.0, -v * std::abs(v));
  set(kNvr, 0.0, 0.0, -std::abs(v) * r);
  set(kNrr, 0.0, 0.0, -r * std::abs(r));
  set(kYuv, 0.0, -u * v, 0.0);
  set(kYur, 0.0, -u * r, 0.0);
  set(kNuv, 0.0, 0.0, -u * v);
  set(kNur, 0.0, 0.0, -u * r);
  const double imbalance = p_[telltale::At(kImbalance)];
  const Thrusts port_acting = (1.0 - imbalance) * port;
  const Thrusts starboard_acting = (1.0 + imbalance) * starboard;
  const Thrusts sum = port_acting + starboard_acting;
  const Thrusts difference = half_separation_m_ * (port_acting - starboard_acting);
  set(kForwardLinear, sum[0], 0.0, difference[0]);
  set(kForwardQuadratic, sum[1], 0.0, difference[1]);
  const double share = reverse_loss_.Share(u);
  set(kReverseLinear, share * sum[2], 0.0, share * difference[2]);
  set(kReverseQuadratic, -share * sum[3], 0.0, -share * difference[3]);
  const double by_loss = reverse_loss_.ByPerSpeed(u);
  set(kReverseLoss, by_loss * reverse_.dot(sum), 0.0, by_loss * reverse_.dot(difference));
  const Thrusts curve = ahead_ + share * reverse_;
  set(kImbalance, curve.dot(starboard - port), 0.0,
      -half_separation_m_ * curve.dot(port + starboard));
  by.bottomRows<2>() = (inverse_mass_ * by.bottomRows<2>()).eval();
  return by;
}

FossenVector WithPositiveMass(FossenVector parameters) {
  const double limit = 0.95 * std::sqrt(parameters[At(kM22)] * parameters[At(kM33)]);
  parameters[At(kM23)] = std::clamp(parameters[At(kM23)], -limit, limit);
  return parameters;
}

Eigen::VectorXd CoefficientsOf(const FossenVector& p, double propeller_separation_m) {
  Eigen::VectorXd c = Eigen::VectorXd::Zero(kCoefficients + 1);
  c[0] = -p[At(kXuu)];
  c[1] = p[At(kM22)];
  c[2] = p[At(kM23)];
  c[3] = -p[At(kXu)];
  const Eigen::Vector4d thrust(p[At(kForwardQuadratic)], p[At(kForwardLinear)],
                               -p[At(kReverseQuadratic)], p[At(kReverseLinear)]);
  c.segment<4>(5) = thrust;

  // One column of sway and yaw, from the force and moment that its regressor has.
  const Eigen::Matrix2d inverse_mass = InverseMass(p);
  const auto set = [&](Eigen::Index column, double force, double moment) {
    const Eigen::Vector2d acceleration = inverse_mass * Eigen::Vector2d(force, moment);
    c[kSurgeCoefficients + column] = acceleration[0];
    c[kSurgeCoefficients + kTurningCoefficients + column] = acceleration[1];
  };
  set(0, -p[At(kYvv)], -p[At(kNvv)]);
  set(1, -p[At(kYrv)], 0.0);
  set(2, 0.0, -p[At(kNvr)]);
  set(3, 0.0, -p[At(kNrr)]);
  set(4, -p[At(kYuv)], 1.0 - p[At(kM22)] - p[At(kNuv)]);
  set(5, -1.0 - p[At(kYur)], -p[At(kM23)] - p[At(kNur)]);
  set(6, -p[At(kYv)], -p[At(kNv)]);
  set(7, -p[At(kYr)], -p[At(kNr)]);
  for (Eigen::Index i = 0; i < 4; ++i) {
    set(9 + i, 0.0, 0.5 * propeller_separation_m * thrust[i]);
  }
  c[kCoefficients] = p[At(kTimeConstant)];
  return c.array() + 0.0;  // no negative zeros
}

double ForwardThrust(const FossenVector& p, double command) {
  const double beyond = std::max(command - p[At(kForwardDeadBand)], 0.0);
  return (p[At(kForwardLinear)] + p[At(kForwardQuadratic)] * beyond) * beyond;
}

double ReverseThrust(const FossenVector& p, double command) {
  const double beyond = std::max(command - p[At(kReverseDeadBand)], 0.0);
  return (p[At(kReverseLinear)] + p[At(kReverseQuadratic)] * beyond) * beyond;
}

DeadZone DeadZoneOf(const FossenVector& parameters) {
  return {parameters[At(kForwardDeadBand)], -parameters[At(kReverseDeadBand)]};
}

ReverseLoss ReverseLossOf(const FossenVector& parameters) {
  return {parameters[At(kReverseLoss)]};
}

VesselModel VesselModelOf(const FossenVector& parameters, double propeller_separation_m) {
  VesselModel model = VesselModel::OfZeros(
      Structure::kFirstOrderDynamic, Parameterization::kPropeller, Discretisation::kContinuous);
  const Eigen::VectorXd all = CoefficientsOf(parameters, propeller_separation_m);
  model.theta[0] = all.head(kSurgeCoefficients);
  model.theta[1] = all.segment(kSurgeCoefficients, kTurningCoefficients);
  model.theta[2] = all.segment(kSurgeCoefficients + kTurningCoefficients, kTurningCoefficients);
  model.dead_zone = DeadZoneOf(parameters);
  model.reverse_loss = ReverseLossOf(parameters);
  model.thrust_imbalance = parameters[At(kImbalance)];
  model.thruster_time_constant_s = parameters[At(kTimeConstant)];
  return model;
}

}  // namespace telltale
