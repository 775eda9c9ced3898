#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <Eigen/Core>

#include "telltale/core/vessel/reverse_loss.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// The physical parameters of a boat in Fossen's form, all divided by m11, the mass with added mass
/// in surge: no recording of a boat without a force sensor shows more.
/// Model, docs/concepts/physical-model.md (101)..(105), with nu the velocity through the water:
///   M nu_dot + C(nu) nu + D(nu) nu = tau,   M = [1 0 0; 0 m22 m23; 0 m23 m33],
/// C follows from M, D nu = [(Xu + Xuu |u|) u; (Yv + Yvv |v| + Yrv |r| + Yuv u) v + (Yr + Yur u) r;
/// (Nv + Nvv |v| + Nuv u) v + (Nr + Nvr |v| + Nrr |r| + Nur u) r], tau = [Tp + Ts; 0; (b / 2) (Tp -
/// Ts)] with Tp = (1 - imbalance) T, Ts = (1 + imbalance) T. A propeller gives T = forward_linear e
/// + forward_quadratic e^2 for e, the command beyond the dead band, and T = -(reverse_linear e +
/// reverse_quadratic e^2) ReverseLoss::Share(u) in reverse, beyond a dead band of its own; thrust
/// follows with a first-order lag. Drag is positive where it opposes the motion. Source: Fossen,
/// Handbook of Marine Craft Hydrodynamics and Motion Control, 2nd ed., 6.5 and 7.1.
enum class FossenParameter : std::size_t {
  kM22,
  kM23,
  kM33,
  kXu,
  kXuu,
  kYv,
  kYr,
  kNv,
  kNr,
  kYvv,
  kYrv,
  kNvv,
  kNvr,
  kNrr,
  kYuv,
  kYur,
  kNuv,
  kNur,
  kForwardLinear,
  kForwardQuadratic,
  kReverseLinear,
  kReverseQuadratic,
  kReverseLoss,
  kImbalance,
  kForwardDeadBand,
  kReverseDeadBand,
  kTimeConstant,
  kCommandDelay,
  kFixDelay,
};

inline constexpr std::size_t kFossenParameters = 29;
using FossenVector = Eigen::Matrix<double, static_cast<int>(kFossenParameters), 1>;

constexpr Eigen::Index At(FossenParameter parameter) {
  return static_cast<Eigen::Index>(parameter);
}

struct FossenParameterName {
  std::string_view symbol;
  std::string_view unit;
  std::string_view meaning;
};

/// Symbol, unit and a few words of meaning in the order of FossenParameter. Masses, drag and thrust
/// are over the mass with added mass in surge.
const std::array<FossenParameterName, kFossenParameters>& FossenParameterNames();

/// Those before the dead bands, which act through the lagged commands.
inline constexpr int kForceParameters = static_cast<int>(FossenParameter::kForwardDeadBand);

/// Accelerations of the physical form with their derivatives.
class FossenDynamics {
 public:
  /// Requires: a positive definite M.
  FossenDynamics(const FossenVector& parameters, double propeller_separation_m);

  using Thrusts = Eigen::Vector4d;  ///< f:d, f:d^2, r:d, r:d^2 of one propeller, after the lag

  struct Evaluation {
    Eigen::Vector3d nu_dot;
    Eigen::Matrix3d by_nu;
  };

  /// nu_dot under the lagged regressors of both propellers.
  Evaluation At(const Eigen::Vector3d& nu, const Thrusts& port, const Thrusts& starboard) const;

  /// d nu_dot / d parameter for the first kForceParameters; `nu_dot` as At() gives it.
  Eigen::Matrix<double, 3, kForceParameters> ByParameter(const Eigen::Vector3d& nu,
                                                         const Eigen::Vector3d& nu_dot,
                                                         const Thrusts& port,
                                                         const Thrusts& starboard) const;

  /// d nu_dot for given changes of the lagged regressors at speed u.
  Eigen::Vector3d ByThrust(double u, const Thrusts& port, const Thrusts& starboard) const;

 private:
  Eigen::Vector3d Propelled(double port, double starboard) const;

  FossenVector p_;
  Thrusts ahead_;    ///< one propeller's thrust over its regressors ahead
  Thrusts reverse_;  ///< and over those in reverse, before any loss
  ReverseLoss reverse_loss_;
  double half_separation_m_;
  Eigen::Matrix2d inverse_mass_;  ///< of sway and yaw
};

/// The steady thrust of one propeller without imbalance, at rest, at a command in [0, 1] ahead or
/// in reverse; positive for both.
double ForwardThrust(const FossenVector& parameters, double command);
double ReverseThrust(const FossenVector& parameters, double command);

DeadZone DeadZoneOf(const FossenVector& parameters);
ReverseLoss ReverseLossOf(const FossenVector& parameters);

/// The same boat in the regressors of Parameterization::kPropeller, with a first-order thruster
/// lag and the reverse loss. It is exact: the physical form lies in their span. Delays are not part
/// of it.
VesselModel VesselModelOf(const FossenVector& parameters, double propeller_separation_m);

/// Its coefficients in the order surge, sway, yaw and of Regressors(), then the time constant.
Eigen::VectorXd CoefficientsOf(const FossenVector& parameters, double propeller_separation_m);

/// The parameters with m23 moved, where it must be, to within 95 % of where M ceases to be positive
/// definite.
FossenVector WithPositiveMass(FossenVector parameters);

}  // namespace telltale
