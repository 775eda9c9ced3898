#include "telltale/core/diagnosis/hypotheses/refit.hpp"

#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

namespace telltale {

EffectFit Refit(const EffectFit& fit, const DiagnosisProblem& problem, const ResidualMetric& metric,
                std::size_t threads) {
  EffectFit deterministic = fit;
  std::erase_if(deterministic.effects,
                [](const auto& modelled) { return modelled.effect->IsStochastic(); });
  if (!deterministic.effects.empty()) {
    deterministic = FitEffects(ErrorModelOf(problem.runs, problem.nominal.boat), metric,
                               deterministic.Effects(), {deterministic.Values()});
  }
  if (deterministic.effects.size() == fit.effects.size()) return deterministic;
  const bool alone = deterministic.effects.empty();
  const EffectFit stochastic =
      FitStochasticExcitation(*fit.effects.back().effect, problem, metric,
                              alone ? problem.recording.errors : deterministic.errors, threads);
  return alone ? stochastic : WithStochasticEffect(deterministic, stochastic);
}

}  // namespace telltale
