#include "telltale/core/diagnosis/report/separation_advice.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/expected_separation.hpp"
#include "telltale/core/diagnosis/report/simulated_manoeuvre.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/simulation/manoeuvre_catalogue.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"

namespace telltale {
namespace {

/// Nats between a hypothesis and the closest of its equivalents in one manoeuvre. None where the
/// manoeuvre cannot be simulated or leaves no windows.
std::optional<double> NatsOf(const CatalogueManoeuvre& manoeuvre,
                             const RankedHypothesis& hypothesis, const NominalBaseline& nominal,
                             double sampling_period_s, const HullParticulars& hull) {
  const auto dataset = SimulatedManoeuvre(manoeuvre, nominal.boat.model, sampling_period_s, hull);
  if (!dataset) return std::nullopt;
  const FreeRuns runs(*dataset, nominal.boat.model, kDiagnosis.horizons.main_s);
  if (runs.Rows() != nominal.covariance.rows() || runs.Windows() == 0) return std::nullopt;
  const Eigen::MatrixXd one = runs.Errors(nominal.boat.With(hypothesis.fit.effects));
  double least = std::numeric_limits<double>::infinity();
  for (const EffectFit& other : hypothesis.equivalent) {
    least = std::min(
        least, ExpectedSeparation(one, runs.Errors(nominal.boat.With(other.effects)), nominal));
  }
  return least;
}

}  // namespace

std::vector<SeparationAdvice> AdviseSeparatingManoeuvres(const RankedHypothesis& hypothesis,
                                                         const NominalBaseline& nominal,
                                                         double sampling_period_s,
                                                         const HullParticulars& hull) {
  std::vector<SeparationAdvice> all;
  if (hypothesis.equivalent.empty()) return all;
  std::vector<std::string> separated = hypothesis.fit.Names();
  for (const std::string& name : hypothesis.Indistinguishable()) separated.push_back(name);
  for (const CatalogueManoeuvre& manoeuvre : ManoeuvreCatalogue()) {
    const auto nats = NatsOf(manoeuvre, hypothesis, nominal, sampling_period_s, hull);
    if (!nats) continue;
    all.push_back({std::string(manoeuvre.name), std::string(manoeuvre.how), separated,
                   kCatalogueDurationS, *nats, *nats > kDiagnosis.separation.decisive_nats});
  }
  return MostSeparating(std::move(all));
}

std::vector<SeparationAdvice> MostSeparating(std::vector<SeparationAdvice> advice) {
  std::erase_if(advice, [](const SeparationAdvice& one) {
    return one.expected_nats < kDiagnosis.separation.minimum_nats;
  });
  std::stable_sort(advice.begin(), advice.end(),
                   [](const auto& a, const auto& b) { return a.expected_nats > b.expected_nats; });
  if (advice.size() > kDiagnosis.separation.most_advice)
    advice.resize(kDiagnosis.separation.most_advice);
  return advice;
}

std::string AdviseSensor(const RankedHypothesis& hypothesis) {
  const Effect* effect = hypothesis.fit.effects.front().effect;
  return "To settle whether it is " + std::string(effect->Facts().title) + ": " +
         std::string(effect->Facts().settled_by) + ".";
}

}  // namespace telltale
