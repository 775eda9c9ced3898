#include "telltale/core/diagnosis/report/causes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/shapley.hpp"
#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"
#include "telltale/core/diagnosis/residuals/wave_direction.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

/// A compass point is told where the direction is known to an eighth of a turn.
constexpr double kLargestStatedRad = std::numbers::pi / 4.0;

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

/// The length of the first two of an effect's values, by the delta method.
ParameterEstimate LengthOf(const EffectFacts& facts, const Eigen::Vector2d& values,
                           const Eigen::Matrix2d& covariance) {
  const Eigen::Vector2d along = values.normalized();
  return {std::string(facts.length_name), values.norm(),
          std::sqrt(std::max(along.dot(covariance * along), 0.0)),
          std::string(facts.parameters.front().unit)};
}

/// `covariance`: of its values.
CausalEffect CausalEffectOf(const ModelledEffect& modelled, const Eigen::MatrixXd& covariance) {
  const auto& [effect, values] = modelled;
  CausalEffect causal;
  causal.effect = effect->Name();
  causal.sentence = effect->Describe(values);
  for (std::size_t j = 0; j < values.size(); ++j) {
    const EffectParameter& parameter = effect->Parameters()[j];
    const auto i = static_cast<Eigen::Index>(j);
    causal.parameters.push_back({std::string(parameter.name), values[j],
                                 std::sqrt(std::max(covariance(i, i), 0.0)),
                                 std::string(parameter.unit)});
  }
  if (effect->Facts().length_name.empty()) return causal;
  const Eigen::Vector2d first(values[0], values[1]);
  const Eigen::Matrix2d of_first = covariance.topLeftCorner<2, 2>();
  causal.size = LengthOf(effect->Facts(), first, of_first);
  if (effect->Facts().is_north_east) {
    causal.towards = DirectionOf(first, of_first, kDiagnosis.gap.level);
  }
  return causal;
}

std::vector<CausalEffect> CausalEffectsOf(const EffectFit& fit) {
  std::vector<CausalEffect> effects;
  Eigen::Index first = 0;
  for (const ModelledEffect& modelled : fit.effects) {
    const auto size = static_cast<Eigen::Index>(modelled.values.size());
    effects.push_back(CausalEffectOf(modelled, fit.covariance.block(first, first, size, size)));
    first += size;
  }
  return effects;
}

/// Where the waves of a fit run to, beside its other effects.
CircularInterval WavesTowards(const EffectFit& fit, const DiagnosisProblem& problem,
                              std::uint64_t seed) {
  const std::vector<ModelledEffect> others = fit.Deterministic().effects;
  const PreparedDataset sharp = Sharpened(problem.runs.Dataset());
  return WaveDirectionOf(AccelerationResidualsOf(sharp, problem.nominal.boat.With(others)),
                         sharp.sampling_period_s, PeakBeside(*fit.Stochastic(), others, problem),
                         seed);
}

/// The stochastic effect of a fit stands last.
void AddDirectionOfWaves(const EffectFit& fit, const DiagnosisProblem& problem, std::uint64_t seed,
                         CausalEffect& waves) {
  waves.towards = WavesTowards(fit, problem, seed);
  if (waves.towards->half_width_rad > kLargestStatedRad) return;
  const double centre = waves.towards->centre_rad;
  waves.sentence += ", running " + Towards(std::cos(centre), std::sin(centre));
  if (waves.towards->or_opposite) waves.sentence += " or the opposite way";
}

Cause CauseOf(const RankedHypothesis& ranked, const DiagnosisProblem& problem, std::uint64_t seed) {
  Cause cause;
  cause.effects = CausalEffectsOf(ranked.fit);
  if (ranked.fit.Stochastic() != nullptr) {
    AddDirectionOfWaves(ranked.fit, problem, seed, cause.effects.back());
  }
  cause.probability = ranked.probability;
  cause.indistinguishable = ranked.Indistinguishable();
  return cause;
}

}  // namespace

std::vector<Cause> CausesOf(const Conclusion& conclusion, const DiagnosisProblem& problem,
                            const HorizonErrors& main, std::uint64_t seed) {
  const AugmentedModel& boat = problem.nominal.boat;
  std::vector<Cause> causes;
  for (const RankedHypothesis& ranked : conclusion.ranking.fits) {
    const bool is_first = causes.empty();
    if (causes.size() == kDiagnosis.report.most_causes) break;
    if (!is_first && ranked.probability < kDiagnosis.report.minimum_listed_probability) break;
    Cause& cause = causes.emplace_back(CauseOf(ranked, problem, seed));
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
