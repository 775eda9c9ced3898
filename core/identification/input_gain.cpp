#include "telltale/core/identification/input_gain.hpp"

#include <cmath>
#include <limits>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

/// Phi_propeller over all coefficients: row j is zero outside the propeller coefficients of
/// equation j.
Eigen::MatrixXd PropellerRows(const Identification& identification,
                              const ThrustRegressors& thrust) {
  const auto size = static_cast<Eigen::Index>(identification.coefficients.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, size);
  Eigen::Index next = 0;
  for (const Equation equation : kEquations) {
    if (!identification.Has(equation)) continue;
    const auto regressors = Regressors(equation, identification.parameterization);
    const std::size_t body = BodyRegressors(equation);
    for (std::size_t i = body; i < regressors.size(); ++i) {
      rows(static_cast<Eigen::Index>(IndexOf(equation)), next + static_cast<Eigen::Index>(i)) =
          thrust.Of(equation)[i - body];
    }
    next += static_cast<Eigen::Index>(regressors.size());
  }
  return rows;
}

void MakeUnknown(Eigen::Matrix3d& covariance, Eigen::Index axis) {
  covariance.row(axis).setZero();
  covariance.col(axis).setZero();
  covariance(axis, axis) = std::numeric_limits<double>::infinity();
}

/// rows Sigma rows', where a coefficient of infinite variance counts only if it is at work.
Eigen::Matrix3d Propagate(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& sigma) {
  const Eigen::MatrixXd finite =
      sigma.unaryExpr([](double value) { return std::isfinite(value) ? value : 0.0; });
  Eigen::Matrix3d covariance = rows * finite * rows.transpose();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (Eigen::Index i = 0; i < rows.cols(); ++i) {
      if (rows(axis, i) != 0.0 && !std::isfinite(sigma(i, i))) MakeUnknown(covariance, axis);
    }
  }
  return covariance;
}

/// combine(a, b) regressor by regressor.
template <class Combine>
ThrustRegressors Combined(const ThrustRegressors& a, const ThrustRegressors& b, Combine combine) {
  ThrustRegressors result;
  for (std::size_t i = 0; i < result.surge.size(); ++i) {
    result.surge[i] = combine(a.surge[i], b.surge[i]);
    result.turning[i] = combine(a.turning[i], b.turning[i]);
  }
  return result;
}

/// nu_dot of the propellers alone.
NuDot PropellerPart(const VesselModel& model, const ThrustRegressors& thrust) {
  const auto part = [&](Equation equation) {
    const Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
    const auto body = static_cast<Eigen::Index>(BodyRegressors(equation));
    double sum = 0.0;
    for (Eigen::Index i = body; i < theta.size(); ++i) {
      sum += theta[i] * thrust.Of(equation)[static_cast<std::size_t>(i - body)];
    }
    return sum;
  };
  return {part(Equation::kSurge), part(Equation::kSway), part(Equation::kYaw)};
}

}  // namespace

InputGain GainUnder(const Identification& identification, const ThrustRegressors& thrust) {
  const auto size = static_cast<Eigen::Index>(identification.coefficients.size());
  Require(identification.covariance.rows() == size && identification.covariance.cols() == size,
          "a covariance over all coefficients");
  const Eigen::MatrixXd rows = PropellerRows(identification, thrust);
  InputGain gain{rows * identification.Estimates(), Propagate(rows, identification.covariance)};
  for (const Equation equation : kEquations) {
    if (identification.Has(equation)) continue;
    MakeUnknown(gain.covariance, static_cast<Eigen::Index>(IndexOf(equation)));
  }
  return gain;
}

InputGain SteadyInputGain(const Identification& identification, const PropellerCommand& delta) {
  return GainUnder(identification, ThrustersOf(identification).SteadyThrust(delta));
}

LaggedInputGain::LaggedInputGain(const Identification& identification,
                                 const PropellerCommand& settled_on)
    : identification_(&identification), thrusters_(ThrustersOf(identification)) {
  Require(HasLag(identification.structure) && identification.thruster_time_constant.has_value() &&
              identification.thruster_time_constant->estimate > 0.0,
          "the dynamic structure with a positive time constant");
  Require(identification.time_constant_covariance.size() ==
              static_cast<Eigen::Index>(identification.coefficients.size()),
          "a covariance of the time constant with every coefficient");
  thrust_ = thrusters_.SteadyThrust(settled_on);
}

InputGain LaggedInputGain::Advance(const PropellerCommand& delta, double elapsed_s) {
  Require(elapsed_s >= 0.0, "time that does not run backwards");
  const double tau = *thrusters_.thruster_time_constant_s;
  const double alpha = std::exp(-elapsed_s / tau);
  const double alpha_by_tau = alpha * elapsed_s / (tau * tau);
  const ThrustRegressors gap = Combined(thrust_, thrusters_.SteadyThrust(delta),
                                        [](double now, double steady) { return now - steady; });
  by_tau_ = Combined(by_tau_, gap, [&](double by_tau, double apart) {
    return alpha * by_tau + alpha_by_tau * apart;
  });
  thrust_ = thrusters_.ThrustAfter(thrust_, delta, elapsed_s);
  initial_share_ *= alpha;
  return Now();
}

InputGain LaggedInputGain::Advance(const PropellerCommand& delta) {
  return Advance(delta, identification_->sampling_period_s);
}

InputGain LaggedInputGain::Now() const {
  InputGain now = GainUnder(*identification_, thrust_);
  const Eigen::Vector3d by_tau = GainUnder(*identification_, by_tau_).gain;
  const double tau_error = identification_->thruster_time_constant->standard_error;
  if (by_tau.isZero(0.0)) return now;
  if (!std::isfinite(tau_error)) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (by_tau[axis] != 0.0) MakeUnknown(now.covariance, axis);
    }
    return now;
  }
  const Eigen::Vector3d with_tau =
      PropellerRows(*identification_, thrust_) * identification_->time_constant_covariance;
  now.covariance += tau_error * tau_error * by_tau * by_tau.transpose() +
                    with_tau * by_tau.transpose() + by_tau * with_tau.transpose();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(now.covariance(axis, axis))) MakeUnknown(now.covariance, axis);
  }
  return now;
}

double SettlingTime(double time_constant_s, double remaining) {
  Require(time_constant_s >= 0.0, "a time constant that is not negative");
  Require(remaining > 0.0 && remaining <= 1.0, "a remaining share in (0, 1]");
  return -time_constant_s * std::log(remaining);
}

std::vector<DisturbanceSample> ReconstructDisturbance(const PreparedDataset& dataset,
                                                      const VesselModel& model) {
  const double h = dataset.sampling_period_s;
  Require(h > 0.0, "a positive sampling period");
  std::vector<DisturbanceSample> samples;
  for (const RowRange& segment : dataset.segments) {
    if (segment.size() == 0) continue;
    ThrustRegressors thrust = model.SteadyThrust(dataset.rows[segment.begin].delta);
    for (std::size_t k = segment.begin; k + 1 < segment.end; ++k) {
      const PreparedRow& row = dataset.rows[k];
      const Nu& now = row.nu;
      const Nu& next = dataset.rows[k + 1].nu;
      const NuDot propelled = PropellerPart(model, model.MeanThrust(thrust, row.delta, h));
      samples.push_back({row.time_s,
                         {(next.u - now.u) / h - propelled.u, (next.v - now.v) / h - propelled.v,
                          (next.r - now.r) / h - propelled.r}});
      thrust = model.ThrustAfter(thrust, row.delta, h);
    }
  }
  return samples;
}

}  // namespace telltale
