#include "telltale/core/diagnosis/separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/free_runs.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

constexpr double kHorizonS = 5.0;
constexpr double kPromisedNats = 5.0;
constexpr double kWorthSayingNats = 1.0;
constexpr std::size_t kMostAdvice = 3;
constexpr double kCruise = 0.4;  // share of full command at which a manoeuvre begins, for a while
constexpr double kCruiseS = 10.0;
// Beyond these a rehearsal has run away and teaches nothing.
constexpr double kFastestMps = 20.0;
constexpr double kFastestRadps = 10.0;

/// A recording of the manoeuvre as a boat like this one would make it, without noise: commands and
/// a course to start windows from.
std::optional<PreparedDataset> Rehearsed(const CatalogueManoeuvre& manoeuvre,
                                         const VesselModel& model, double sampling_period_s) {
  VesselModel carrier = model;
  carrier.structure = Structure::kStaticQuadratic;
  carrier.discretisation = Discretisation::kContinuous;
  const Vehicle vehicle{"rehearsal", 1.0, {}, {}, {}, std::nullopt};
  const auto commands =
      Schedule({Manoeuvre{{{kCruise, kCruise}, kCruiseS}}, manoeuvre.manoeuvre}, 0.0);
  const double end_s = kCruiseS + kCatalogueDurationS;
  const auto track = Simulate(carrier, {}, commands, end_s, sampling_period_s / 10.0);
  const auto runs_away = [](const TimedState& now) {
    const Nu& nu = now.state.nu;
    return !(std::hypot(nu.u, nu.v) < kFastestMps && std::abs(nu.r) < kFastestRadps);
  };
  if (std::any_of(track.begin(), track.end(), runs_away)) return std::nullopt;
  SensorOptions sensors;
  sensors.position_noise_m = 0.0;
  sensors.heading_noise_deg = 0.0;
  PrepareOptions options;
  options.sampling_period_s = sampling_period_s;
  auto dataset = Prepare(Measure(track, vehicle, sensors), vehicle, options);
  if (!dataset) return std::nullopt;
  return *std::move(dataset);
}

}  // namespace

std::vector<SeparationAdvice> AdviseSeparation(const RankedFit& tied, const Healthy& healthy,
                                               double sampling_period_s) {
  std::vector<SeparationAdvice> all;
  if (tied.alike.empty()) return all;
  const Eigen::LLT<Eigen::MatrixXd> factor(healthy.covariance);
  std::vector<std::string> separated = tied.fit.Names();
  for (const std::string& name : tied.Indistinguishable()) separated.push_back(name);
  for (const CatalogueManoeuvre& manoeuvre : ManoeuvreCatalogue()) {
    const auto dataset = Rehearsed(manoeuvre, healthy.boat.model, sampling_period_s);
    if (!dataset) continue;
    const FreeRuns runs(*dataset, healthy.boat.model, kHorizonS);
    if (runs.Rows() != healthy.covariance.rows() || runs.Windows() == 0) continue;
    const Eigen::MatrixXd one = runs.Errors(healthy.boat.With(tied.fit.effects));
    double nats = std::numeric_limits<double>::infinity();
    for (const EffectFit& other : tied.alike) {
      const Eigen::MatrixXd apart = one - runs.Errors(healthy.boat.With(other.effects));
      const double expected = static_cast<double>(apart.size());
      const double square = factor.matrixL().solve(apart).squaredNorm();
      const double looks = kLooksAWindow * healthy.kappa * static_cast<double>(apart.cols());
      nats = std::min(nats, NatsOf(looks, square / expected));
    }
    if (nats < kWorthSayingNats) continue;
    all.push_back({std::string(manoeuvre.name), std::string(manoeuvre.how), separated,
                   kCatalogueDurationS, nats, nats > kPromisedNats});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.expected_nats > b.expected_nats; });
  if (all.size() > kMostAdvice) all.resize(kMostAdvice);
  return all;
}

std::string SensorThatSettles(const RankedFit& tied) {
  const Effect* effect = tied.fit.effects.front().effect;
  return "To settle whether it is " + std::string(effect->Facts().title) + ": " +
         std::string(effect->Facts().settled_by) + ".";
}

}  // namespace telltale
