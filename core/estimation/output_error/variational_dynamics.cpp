#include "telltale/core/estimation/output_error/variational_dynamics.hpp"

#include <cmath>
#include <span>

#include "telltale/core/vessel/runge_kutta.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {

SegmentThrusters::SegmentThrusters(const ShootingSegment& shooting_segment,
                                   std::optional<double> time_constant_s)
    : time_constant_s_(time_constant_s) {
  now_ = {TermsOf(shooting_segment.before.front().steady), ThrustTerms::Zero()};
  for (const ShootingSegment::Held& held : shooting_segment.before) {
    if (held.duration_s > 0.0) Advance(held.steady, held.duration_s);
  }
}

ThrustOverStep SegmentThrusters::Advance(const ThrustRegressors& steady_thrust, double duration_s) {
  const ThrustTerms steady = TermsOf(steady_thrust);
  if (!time_constant_s_) {
    now_ = {steady, ThrustTerms::Zero()};
    return {now_, now_, now_};
  }
  const LagPerPeriod lag = LagOver(*time_constant_s_ / duration_s);
  const ThrustWithSlope start = now_;
  const ThrustTerms behind = start.now - steady;
  now_.now = Approach(start.now, steady, lag.remaining);
  now_.by_lag = lag.remaining * start.by_lag + lag.remaining_slope / duration_s * behind;
  const ThrustTerms mean = Approach(start.now, steady, lag.mean);
  const ThrustTerms mean_by_lag = lag.mean * start.by_lag + lag.mean_slope / duration_s * behind;
  const ThrustWithSlope middle{(6.0 * mean - start.now - now_.now) / 4.0,
                               (6.0 * mean_by_lag - start.by_lag - now_.by_lag) / 4.0};
  return {start, middle, now_};
}

VariationalDynamics::VariationalDynamics(const SharedUnknowns& unknowns,
                                         const Eigen::VectorXd& theta, bool varied)
    : dynamics_(unknowns.ModelWith(theta, 0.0)), unknowns_(unknowns), varied_(varied) {
  for (const Equation equation : kEquations) {
    first_[IndexOf(equation)] = kFirstShared + unknowns.First(equation);
  }
}

SensitiveState VariationalDynamics::Step(const SensitiveState& from, const ThrustOverStep& thrust,
                                         double h) const {
  return RungeKuttaStep(
      from, h,
      [&](const SensitiveState& at, StepStage stage) {
        return Slope(at, stage == StepStage::kStart    ? thrust.start
                         : stage == StepStage::kMiddle ? thrust.middle
                                                       : thrust.end);
      },
      [&](const SensitiveState& at, const SensitiveState& slope, double step_s) {
        return Along(at, slope, step_s);
      },
      [&](const SensitiveState& k1, const SensitiveState& k2, const SensitiveState& k3,
          const SensitiveState& k4) {
        SensitiveState to;
        to.state = from.state + h / 6 * (k1.state + 2 * k2.state + 2 * k3.state + k4.state);
        if (varied_) {
          to.sensitivity =
              from.sensitivity +
              h / 6 * (k1.sensitivity + 2 * k2.sensitivity + 2 * k3.sensitivity + k4.sensitivity);
        }
        return to;
      });
}

SensitiveState VariationalDynamics::Along(const SensitiveState& from, const SensitiveState& slope,
                                          double h) const {
  SensitiveState to;
  to.state = from.state + h * slope.state;
  if (varied_) to.sensitivity = from.sensitivity + h * slope.sensitivity;
  return to;
}

SensitiveState VariationalDynamics::Slope(const SensitiveState& at,
                                          const ThrustWithSlope& thrust) const {
  const Nu nu = at.Velocity();
  const ThrustRegressors applied = RegressorsOf(thrust.now);
  const NuDot nu_dot = dynamics_.Under(dynamics_.Propelled(applied), nu);
  const double c = std::cos(at.state[2]);
  const double s = std::sin(at.state[2]);
  SensitiveState slope;
  slope.state << c * nu.u - s * nu.v, s * nu.u + c * nu.v, nu.r, nu_dot.u, nu_dot.v, nu_dot.r;
  if (!varied_) return slope;
  const Sensitivity& S = at.sensitivity;
  slope.sensitivity.row(0) = c * S.row(3) - s * S.row(4) - slope.state[1] * S.row(2);
  slope.sensitivity.row(1) = s * S.row(3) + c * S.row(4) + slope.state[0] * S.row(2);
  slope.sensitivity.row(2) = S.row(5);
  const Eigen::Matrix3d A = dynamics_.ByVelocity(nu);
  for (Eigen::Index j = 0; j < 3; ++j) {
    slope.sensitivity.row(3 + j) = A(j, 0) * S.row(3) + A(j, 1) * S.row(4) + A(j, 2) * S.row(5);
  }
  AddShared(nu, applied, RegressorsOf(thrust.by_lag), slope.sensitivity);
  return slope;
}

/// Adds the derivatives of the accelerations by the shared unknowns themselves.
void VariationalDynamics::AddShared(const Nu& nu, const ThrustRegressors& applied,
                                    const ThrustRegressors& by_lag,
                                    Sensitivity& sensitivity) const {
  std::array<double, 16> row{};
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    const auto& columns = unknowns_.columns[j];
    if (columns.empty()) continue;
    FillRow(equation, nu, applied,
            std::span(row).first(Regressors(equation, unknowns_.parameterization).size()));
    double* to = &sensitivity(3 + static_cast<Eigen::Index>(j), first_[j]);
    for (std::size_t i = 0; i < columns.size(); ++i) to[i] += row[columns[i]];
  }
  if (!unknowns_.lagging) return;
  const NuDot slope = dynamics_.Propelled(by_lag);
  sensitivity.col(kFirstShared).tail<3>() += Eigen::Vector3d(slope.u, slope.v, slope.r);
}

}  // namespace telltale
