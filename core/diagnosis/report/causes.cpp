#include "telltale/core/diagnosis/report/causes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/shapley.hpp"

namespace telltale {
namespace {

/// The fits of each fold, less the effects that are not in `subset`, bit i of which is effect i.
FoldFits Subset(FoldFits folds, std::size_t subset) {
  for (EffectFit& fit : folds) {
    std::vector<ModelledEffect> kept;
    for (std::size_t i = 0; i < fit.effects.size(); ++i) {
      if (((subset >> i) & 1) != 0) kept.push_back(fit.effects[i]);
    }
    fit.effects = kept;
  }
  return folds;
}

/// By how much each subset of the effects lowers the mean squared gap.
std::vector<double> DecreasesBySubset(const FoldFits& folds, const AugmentedModel& boat,
                                      const HorizonErrors& main) {
  const auto squared_gap = [&](std::size_t subset) {
    const CrossValidatedErrors cross_validated =
        CrossValidatedErrorsOf(Subset(folds, subset), main.runs, boat);
    return CrossValidatedSquaredGaps(cross_validated, main.runs, main.floor, kAllChannels).mean();
  };
  const double none = squared_gap(0);
  std::vector<double> decreases(std::size_t{1} << folds.front().effects.size());
  for (std::size_t subset = 1; subset < decreases.size(); ++subset) {
    decreases[subset] = none - squared_gap(subset);
  }
  return decreases;
}

void AssignShapleyShares(const FoldFits& folds, const AugmentedModel& boat,
                         const HorizonErrors& main, std::vector<CausalEffect>& effects) {
  const std::vector<double> shares = ShapleyShares(DecreasesBySubset(folds, boat, main));
  for (std::size_t i = 0; i < effects.size(); ++i) effects[i].shapley_share = shares[i];
}

Cause CauseOf(const RankedHypothesis& ranked) {
  Cause cause;
  cause.effects = CausalEffectsOf(ranked.fit);
  cause.probability = ranked.probability;
  cause.indistinguishable = ranked.Indistinguishable();
  return cause;
}

}  // namespace

std::vector<CausalEffect> CausalEffectsOf(const EffectFit& fit) {
  std::vector<CausalEffect> effects;
  Eigen::Index i = 0;
  for (const auto& [effect, values] : fit.effects) {
    CausalEffect& causal = effects.emplace_back();
    causal.effect = effect->Name();
    causal.sentence = effect->Describe(values);
    for (std::size_t j = 0; j < values.size(); ++j, ++i) {
      const EffectParameter& parameter = effect->Parameters()[j];
      causal.parameters.push_back({std::string(parameter.name), values[j],
                                   std::sqrt(std::max(fit.covariance(i, i), 0.0)),
                                   std::string(parameter.unit)});
    }
  }
  return effects;
}

std::vector<Cause> CausesOf(const Conclusion& conclusion, const DiagnosisProblem& problem,
                            const HorizonErrors& main, std::uint64_t seed) {
  const AugmentedModel& boat = problem.nominal.boat;
  std::vector<Cause> causes;
  for (const RankedHypothesis& ranked : conclusion.ranking.fits) {
    const bool is_first = causes.empty();
    if (causes.size() == kDiagnosis.report.most_causes) break;
    if (!is_first && ranked.probability < kDiagnosis.report.minimum_listed_probability) break;
    Cause& cause = causes.emplace_back(CauseOf(ranked));
    if (is_first) {
      if (cause.effects.size() > 1)
        AssignShapleyShares(conclusion.folds, boat, main, cause.effects);
      cause.excess_explained = conclusion.excess_explained;
      continue;
    }
    const FoldFits folds = FitOnFolds(ranked.fit, problem);
    cause.excess_explained =
        ExcessExplainedAt(main, CrossValidatedErrorsOf(folds, main.runs, boat), kAllChannels, seed);
  }
  Cause unknown;
  unknown.probability = conclusion.ranking.unknown + conclusion.ranking.no_effect;
  causes.push_back(unknown);
  std::stable_sort(causes.begin(), causes.end(),
                   [](const Cause& a, const Cause& b) { return a.probability > b.probability; });
  return causes;
}

}  // namespace telltale
