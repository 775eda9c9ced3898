#include "telltale/core/simulation/simulator.hpp"

#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/time_series.hpp"
#include "telltale/core/vessel/runge_kutta.hpp"

namespace telltale {
namespace {

Nu RungeKutta(const VesselModel& model, const VesselState& state, const PropellerCommand& delta,
              double h) {
  const ThrustRegressors start = model.ThrustAfter(state.thrust, delta, 0.0);
  const ThrustRegressors middle = model.ThrustAfter(state.thrust, delta, h / 2);
  const ThrustRegressors end = model.ThrustAfter(state.thrust, delta, h);
  return RungeKuttaStep(state.nu, h, [&](const Nu& nu, StepStage stage) {
    return model.AccelerationUnder(stage == StepStage::kStart    ? start
                                   : stage == StepStage::kMiddle ? middle
                                                                 : end,
                                   nu);
  });
}

Nu NextVelocity(const VesselModel& model, const VesselState& state, const PropellerCommand& delta,
                double step_s) {
  Require(step_s > 0.0, "a positive step");
  if (model.discretisation == Discretisation::kContinuous) {
    return RungeKutta(model, state, delta, step_s);
  }
  Require(model.discretisation == Discretisation::kForwardEuler, "a named discretisation");
  Require(std::abs(step_s - model.sampling_period_s) <= kSameInstantS,
          "a discrete model stepped by its own sampling period");
  const ThrustRegressors mean = model.MeanThrust(state.thrust, delta, step_s);
  return Along(state.nu, model.AccelerationUnder(mean, state.nu), step_s);
}

}  // namespace

Eta NextPose(const Eta& eta, const Nu& before, const Nu& after, double step_s) {
  const double psi_rad = eta.psi_rad + step_s * (before.r + after.r) / 2;
  const Nu mean{(before.u + after.u) / 2, (before.v + after.v) / 2, (before.r + after.r) / 2};
  const Eigen::Vector3d slope = EtaDot((eta.psi_rad + psi_rad) / 2, mean);
  return {eta.x_m + step_s * slope.x(), eta.y_m + step_s * slope.y(), psi_rad};
}

VesselState Advance(const VesselModel& model, const VesselState& state,
                    const PropellerCommand& delta, double step_s) {
  const Nu nu = NextVelocity(model, state, delta, step_s);
  return {NextPose(state.eta, state.nu, nu, step_s), nu,
          model.ThrustAfter(state.thrust, delta, step_s)};
}

std::vector<TimedState> Simulate(const VesselModel& model, const VesselState& initial,
                                 const std::vector<TimedCommand>& commands, double end_s,
                                 double step_s) {
  Require(!commands.empty(), "at least one command");
  Require(step_s > 0.0, "a positive step");
  const double start_s = commands.front().time_s;
  Require(end_s >= start_s, "an end that is not before the first command");

  const auto steps = static_cast<std::size_t>((end_s - start_s + kSameInstantS) / step_s);
  std::vector<TimedState> track;
  track.reserve(steps + 1);
  VesselState state = initial;
  auto held = commands.begin();
  for (std::size_t k = 0; k <= steps; ++k) {
    const double time_s = start_s + static_cast<double>(k) * step_s;
    while (held + 1 != commands.end() && (held + 1)->time_s <= time_s + kSameInstantS) {
      Require((held + 1)->time_s >= held->time_s, "commands in order of time");
      ++held;
    }
    track.push_back({time_s, state, held->delta});
    state = Advance(model, state, held->delta, step_s);
  }
  return track;
}

}  // namespace telltale
