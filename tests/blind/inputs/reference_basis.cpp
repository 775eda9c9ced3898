#include "inputs/reference_basis.hpp"

#include <algorithm>
#include <stdexcept>

#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"
#include "telltale/core/diagnosis/hypotheses/variation.hpp"

namespace blind {
namespace {

using telltale::FreeRuns;

constexpr double kHorizonS = 5.0;

std::vector<const telltale::Effect*> EffectsOfTheMean() {
  const auto library = telltale::EffectLibrary();
  std::vector<const telltale::Effect*> effects(library.begin(), library.end());
  std::erase_if(effects, [](const auto* effect) { return effect->IsIntermittent(); });
  return effects;
}

/// The scatter of spells among these effects; 0 where there are none. A model does not say how
/// large it is: the middle one of what their effect may have.
double SpellScatterOf(const std::vector<telltale::ModelledEffect>& effects) {
  for (const auto& [effect, values] : effects) {
    if (effect->IsIntermittent()) return telltale::MiddleScatterOf(*effect);
  }
  return 0.0;
}

std::vector<FreeRuns> ReferenceRuns(const DiagnosisInputs& inputs) {
  std::vector<FreeRuns> nominal;
  for (const telltale::PreparedDataset& reference : inputs.references) {
    FreeRuns runs(reference, inputs.model.model, kHorizonS);
    if (runs.Windows() > 0) nominal.push_back(std::move(runs));
  }
  if (nominal.empty()) {
    throw std::invalid_argument("no reference has five seconds without a gap");
  }
  return nominal;
}

}  // namespace

ReferenceBasis::ReferenceBasis(const DiagnosisInputs& given)
    : inputs(given),
      candidates(EffectsOfTheMean()),
      parameter_refs(telltale::EffectParameterRefsOf(candidates)),
      runs(given.recording, given.model.model, kHorizonS),
      reference_runs(ReferenceRuns(given)),
      nominal(telltale::LearnNominalBaseline(reference_runs, given.model, parameter_refs, 1)),
      floor(telltale::NoiseFloorOf(reference_runs, nominal.boat)) {
  if (runs.Windows() == 0) {
    throw std::invalid_argument("the recording has no five seconds without a gap");
  }
}

std::optional<double> ReferenceBasis::ClosureBy(const telltale::AugmentedModel& model) const {
  const double before = SquaredGap(nominal.boat);
  if (before <= floor.SquaredLimit(telltale::kAllChannels)) return std::nullopt;
  return (before - SquaredGap(model)) / (before - floor.Squared(telltale::kAllChannels));
}

double ReferenceBasis::SquaredGap(const telltale::AugmentedModel& model) const {
  const auto mean = [&](const Eigen::MatrixXd& errors) {
    return telltale::SquaredGaps(errors, floor.scale, telltale::kAllChannels).mean();
  };
  telltale::EffectFit fit;
  fit.effects = model.effects;
  fit.intermittent_sd = SpellScatterOf(model.effects);
  fit.variation =
      telltale::VariationOf(model.effects, fit.intermittent_sd, runs.Errors(model),
                            telltale::ErrorModelOf(runs, nominal.boat), runs.HorizonS());
  fit.scatter = telltale::ScatterOf(model.effects, runs, nominal.boat);
  const Eigen::VectorXd stochastic = telltale::StochasticMeanSquares(fit, runs, nominal.boat);
  const double gap = mean(runs.Errors(model));
  // Stochastic excitation explains no more than there is to explain, as in the report.
  const double there = std::max(gap - floor.Squared(telltale::kAllChannels), 0.0);
  return gap - std::min(mean(stochastic.cwiseMax(0.0).cwiseSqrt()), there);
}

telltale::AugmentedModel ReferenceBasis::With(
    const std::vector<telltale::ModelledEffect>& effects) const {
  return nominal.boat.With(effects);
}

}  // namespace blind
