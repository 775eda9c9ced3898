#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// What the propellers do to the velocities: the paper's G over its sampling period, G / h = M^-1
/// tau. Shapes and units: gain and standard errors (surge, sway, yaw) in m/s^2, m/s^2, rad/s^2;
/// Times(h) gives the paper's G in m/s, m/s, rad/s. Infinite variance: a coefficient at work under
/// this command is not known. An equation that the identification lacks has gain 0 and infinite
/// variance; such an axis has zero covariances.
struct InputGain {
  Eigen::Vector3d gain = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  Eigen::Vector3d StandardErrors() const { return covariance.diagonal().cwiseSqrt(); }
  InputGain Times(double h) const { return {h * gain, h * h * covariance}; }
};

/// The gain under given propeller regressors, its bound that of the coefficients alone.
/// Model: gain = Phi_propeller theta, covariance = Phi_propeller Sigma Phi_propeller'.
/// docs/concepts/model.md (25).
InputGain GainUnder(const Identification& identification, const ThrustRegressors& thrust);

/// The gain of a command whose thrust is there at once (static structure) or has settled (dynamic).
/// Source: the paper, input gain for static propeller modelling.
InputGain SteadyInputGain(const Identification& identification, const PropellerCommand& delta);

/// The gain of lagging thrusters, advanced command by command:
/// G(k) = alpha G(k-1) + (1 - alpha) G_steady(delta(k-1)), alpha = exp(-elapsed / tau).
/// The bound is that of the coefficients and the time constant together, the latter by the
/// first-order sensitivity dG/dtau followed along: with P the propeller regressors as they stand
/// and b = dG/dtau, P Sigma P' + b b' var(tau) + P c b' + b c' P', c = time_constant_covariance.
/// What the bound leaves out is the initial condition, whose share left is InitialShare().
/// docs/concepts/model.md (26). Requires: the dynamic structure with its time constant. Source: the
/// paper, input gain for dynamic propeller modelling. `identification` must outlive this.
class LaggedInputGain {
 public:
  /// Thrusters that stand where `settled_on`, held for ever, leads to.
  explicit LaggedInputGain(const Identification& identification,
                           const PropellerCommand& settled_on = {});

  /// The gain `elapsed_s` >= 0 after `delta` was applied, it being held since.
  InputGain Advance(const PropellerCommand& delta, double elapsed_s);

  /// One sampling period of the discrete model: from G(k-1) and delta(k-1) to G(k).
  InputGain Advance(const PropellerCommand& delta);

  InputGain Now() const;

  /// The influence of the initial condition that is left, 1 at first: the product of the alphas so
  /// far.
  double InitialShare() const { return initial_share_; }

 private:
  const Identification* identification_;
  VesselModel thrusters_;  ///< without coefficients: their lag and dead zone alone
  ThrustRegressors thrust_;
  ThrustRegressors by_tau_;  ///< d thrust / d tau
  double initial_share_ = 1.0;
};

/// Seconds until no more than `remaining` of an initial condition is left, tau ln(1 / remaining).
/// docs/concepts/model.md (27). Requires: time_constant_s >= 0, remaining in (0, 1].
/// Source: the paper, the property that the influence of the initial condition vanishes.
double SettlingTime(double time_constant_s, double remaining = 0.01);

/// Everything but the propellers, as it was at one instant.
struct DisturbanceSample {
  double time_s = 0.0;
  NuDot sigma;
};

/// The lumped disturbance over a recording: the acceleration measured between rows k and k + 1
/// minus what the model's propellers give at k, for each k whose successor is in the same segment.
/// docs/concepts/model.md (28). Lagging thrusters are taken to have settled at the start of each
/// segment; a wrong guess decays within SettlingTime.
std::vector<DisturbanceSample> ReconstructDisturbance(const PreparedDataset& dataset,
                                                      const VesselModel& model);

}  // namespace telltale
