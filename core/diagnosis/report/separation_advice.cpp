#include "telltale/core/diagnosis/report/separation_advice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

constexpr double kHorizonS = 5.0;
constexpr double kDecisiveLogEvidence = 5.0;
constexpr double kMinimumLogEvidence = 1.0;
constexpr std::size_t kMaximumAdvice = 3;
constexpr double kCruise = 0.4;  // share of full command at which a manoeuvre begins, for a while
constexpr double kCruiseS = 10.0;

/// A recording of the manoeuvre as a boat like this one would make it, without noise: commands and
/// a course to start windows from.
std::optional<PreparedDataset> SimulatedManoeuvre(const CatalogueManoeuvre& manoeuvre,
                                                  const VesselModel& model,
                                                  double sampling_period_s) {
  VesselModel carrier = model;
  carrier.structure = Structure::kStaticQuadratic;
  carrier.discretisation = Discretisation::kContinuous;
  const Vehicle vehicle{"simulated", 1.0, {}, {}, {}, std::nullopt};
  const auto commands =
      Schedule({Manoeuvre{{{kCruise, kCruise}, kCruiseS}}, manoeuvre.manoeuvre}, 0.0);
  const double end_s = kCruiseS + kCatalogueDurationS;
  const auto track = Simulate(carrier, {}, commands, end_s, sampling_period_s / 10.0);
  const auto diverges = [](const TimedState& now) {
    return kSimulatedManoeuvreDivergence.Exceeds(now.state.nu);
  };
  if (std::any_of(track.begin(), track.end(), diverges)) return std::nullopt;
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

std::vector<SeparationAdvice> AdviseSeparatingManoeuvres(const RankedHypothesis& hypothesis,
                                                         const NominalBaseline& nominal,
                                                         double sampling_period_s,
                                                         const HullParticulars& hull) {
  std::vector<SeparationAdvice> all;
  if (hypothesis.equivalent.empty()) return all;
  const Eigen::LLT<Eigen::MatrixXd> factor(nominal.covariance);
  std::vector<std::string> separated = hypothesis.fit.Names();
  for (const std::string& name : hypothesis.Indistinguishable()) separated.push_back(name);
  for (const CatalogueManoeuvre& manoeuvre : ManoeuvreCatalogue()) {
    auto dataset = SimulatedManoeuvre(manoeuvre, nominal.boat.model, sampling_period_s);
    if (!dataset) continue;
    dataset->hull = hull;
    const FreeRuns runs(*dataset, nominal.boat.model, kHorizonS);
    if (runs.Rows() != nominal.covariance.rows() || runs.Windows() == 0) continue;
    const Eigen::MatrixXd one = runs.Errors(nominal.boat.With(hypothesis.fit.effects));
    double log_evidence = std::numeric_limits<double>::infinity();
    for (const EffectFit& other : hypothesis.equivalent) {
      const Eigen::MatrixXd apart = one - runs.Errors(nominal.boat.With(other.effects));
      const double expected = static_cast<double>(apart.size());
      const double square = factor.matrixL().solve(apart).squaredNorm();
      const double effective_observations =
          kObservationsPerWindow * nominal.kappa * static_cast<double>(apart.cols());
      log_evidence =
          std::min(log_evidence, LogEvidenceOf(effective_observations, square / expected));
    }
    if (log_evidence < kMinimumLogEvidence) continue;
    all.push_back({std::string(manoeuvre.name), std::string(manoeuvre.how), separated,
                   kCatalogueDurationS, log_evidence, log_evidence > kDecisiveLogEvidence});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.expected_nats > b.expected_nats; });
  if (all.size() > kMaximumAdvice) all.resize(kMaximumAdvice);
  return all;
}

std::string AdviseSensor(const RankedHypothesis& hypothesis) {
  const Effect* effect = hypothesis.fit.effects.front().effect;
  return "To settle whether it is " + std::string(effect->Facts().title) + ": " +
         std::string(effect->Facts().settled_by) + ".";
}

}  // namespace telltale
