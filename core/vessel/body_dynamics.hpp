#pragma once

#include <array>
#include <cmath>

#include "telltale/core/vessel/body_regressors.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/regressors.hpp"
#include "telltale/core/vessel/runge_kutta.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// A model's accelerations with its coefficients in fixed arrays, for simulations of many steps.
/// Model: nu_dot = body(nu) + propelled, docs/concepts/model.md (10)..(12). The numbers equal those
/// of VesselModel::AccelerationUnder to rounding. Units: m/s^2 and rad/s^2.
class BodyDynamics {
 public:
  explicit BodyDynamics(const VesselModel& model) {
    for (std::size_t i = 0; i < surge_.size(); ++i) surge_[i] = At(model, 0, i);
    for (std::size_t i = 0; i < sway_.size(); ++i) sway_[i] = At(model, 1, i);
    for (std::size_t i = 0; i < yaw_.size(); ++i) yaw_[i] = At(model, 2, i);
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t body = j == 0 ? surge_.size() : sway_.size();
      const auto size = static_cast<std::size_t>(model.theta[j].size());
      for (std::size_t i = body; i < size; ++i) thrust_[j][i - body] = At(model, j, i);
    }
  }

  /// The part of nu_dot that the propellers give.
  NuDot Propelled(const ThrustRegressors& thrust) const {
    return {Dot(thrust_[0], thrust.surge), Dot(thrust_[1], thrust.turning),
            Dot(thrust_[2], thrust.turning)};
  }

  /// nu_dot at a velocity; `applied` is the sum of the propellers and any disturbance.
  NuDot Under(const NuDot& applied, const Nu& nu) const {
    const BodyRow row = BodyRowAt(nu);
    return {applied.u + Dot(surge_, row.surge), applied.v + Dot(sway_, row.turning),
            applied.r + Dot(yaw_, row.turning)};
  }

  /// d nu_dot / d nu, rows and columns surge, sway, yaw. The slope of |x| at zero is taken as zero.
  Eigen::Matrix3d ByVelocity(const Nu& nu) const {
    const double v_abs = std::abs(nu.v);
    const double r_abs = std::abs(nu.r);
    const double v_sign = SignOf(nu.v);
    const double r_sign = SignOf(nu.r);
    Eigen::Matrix3d slope;
    slope.row(0) << 2.0 * surge_[0] * std::abs(nu.u) + surge_[3], surge_[1] * nu.r,
        surge_[1] * nu.v + 2.0 * surge_[2] * nu.r;
    for (const Eigen::Index j : {1, 2}) {
      const std::array<double, 9>& a = j == 1 ? sway_ : yaw_;
      slope.row(j) << a[4] * nu.v + a[5] * nu.r,
          2.0 * a[0] * v_abs + a[1] * r_abs + a[2] * nu.r * v_sign + a[4] * nu.u + a[6],
          a[1] * nu.v * r_sign + a[2] * v_abs + 2.0 * a[3] * r_abs + a[5] * nu.u + a[7];
    }
    return slope;
  }

  /// The velocity after a Runge-Kutta step of order four with `applied` held throughout.
  Nu Step(const NuDot& applied, const Nu& nu, double step_s) const {
    return RungeKuttaStep(nu, step_s, [&](const Nu& at, StepStage) { return Under(applied, at); });
  }

 private:
  static double SignOf(double value) { return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0; }

  static double At(const VesselModel& model, std::size_t equation, std::size_t i) {
    return model.theta[equation][static_cast<Eigen::Index>(i)];
  }

  template <std::size_t N>
  static double Dot(const std::array<double, N>& a, const std::array<double, N>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < N; ++i) sum += a[i] * b[i];
    return sum;
  }

  std::array<double, 5> surge_{};
  std::array<double, 9> sway_{};
  std::array<double, 9> yaw_{};
  std::array<std::array<double, 4>, 3> thrust_{};
};

}  // namespace telltale
