#include "telltale/core/uncertainty/prediction_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"

namespace telltale {
namespace {

/// Velocities after each step; infinite from where a run blows up.
Eigen::Matrix3Xd Run(const VesselModel& model, const VesselState& start,
                     const std::vector<TimedCommand>& commands, const Disturbance& disturbance,
                     std::size_t steps, double step_s, std::uint64_t seed, double beyond) {
  const BodyDynamics dynamics(model);
  auto disturbance_axes = DrawDisturbances(disturbance, step_s, seed, 0);
  Eigen::Matrix3Xd run = Eigen::Matrix3Xd::Constant(3, static_cast<Eigen::Index>(steps), beyond);
  Nu nu = start.nu;
  ThrustRegressors thrust = start.thrust;
  auto held = commands.begin();
  for (std::size_t k = 0; k < steps; ++k) {
    const double time_s = commands.front().time_s + static_cast<double>(k) * step_s;
    while (held + 1 != commands.end() && (held + 1)->time_s <= time_s + 1e-6) ++held;
    const NuDot propelled =
        dynamics.Propelled(model.ThrustAt(nu.u, model.MeanThrust(thrust, held->delta, step_s)));
    thrust = model.ThrustAfter(thrust, held->delta, step_s);
    nu = dynamics.Step(
        {propelled.u + disturbance_axes[0].Next(), propelled.v + disturbance_axes[1].Next(),
         propelled.r + disturbance_axes[2].Next()},
        nu, step_s);
    if (!std::isfinite(nu.u + nu.v + nu.r)) break;
    run.col(static_cast<Eigen::Index>(k)) << nu.u, nu.v, nu.r;
  }
  return run;
}

}  // namespace

PredictionBand PredictBand(const std::vector<VesselModel>& models, const VesselState& start,
                           const std::vector<TimedCommand>& commands,
                           const Disturbance& disturbance, double horizon_s, double step_s,
                           double level, std::uint64_t seed) {
  Require(models.size() >= 20, "at least twenty models");
  Require(!commands.empty(), "at least one command");
  Require(step_s > 0.0 && horizon_s >= step_s, "a horizon of at least one step");
  Require(level > 0.0 && level < 1.0, "a level in (0, 1)");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto steps = static_cast<std::size_t>(std::lround(horizon_s / step_s));
  std::vector<Eigen::Matrix3Xd> runs;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const double beyond = i % 2 == 0 ? kInfinity : -kInfinity;
    runs.push_back(Run(models[i], start, commands, disturbance, steps, step_s,
                       RandomEngine::Stream(seed, i)(), beyond));
  }
  const auto columns = static_cast<Eigen::Index>(steps);
  PredictionBand band{step_s, Eigen::Matrix3Xd(3, columns), Eigen::Matrix3Xd(3, columns),
                      Eigen::Matrix3Xd(3, columns)};
  std::vector<double> values(runs.size());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  for (Eigen::Index k = 0; k < columns; ++k) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < runs.size(); ++i) values[i] = runs[i](axis, k);
      std::sort(values.begin(), values.end());
      band.lower(axis, k) = at((1.0 - level) / 2.0);
      band.median(axis, k) = at(0.5);
      band.upper(axis, k) = at((1.0 + level) / 2.0);
    }
  }
  return band;
}

}  // namespace telltale
