#include "telltale/core/diagnosis/hypotheses/refit.hpp"

#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

namespace telltale {

EffectFit Refit(const EffectFit& fit, const DiagnosisProblem& problem,
                const ResidualMetric& metric) {
  const EffectFit deterministic = fit.Deterministic();
  const Effect* stochastic = fit.Stochastic();
  if (deterministic.effects.empty())
    return FitStochasticExcitation(*stochastic, problem.excitation, problem, metric,
                                   problem.recording.errors);
  const auto effects = deterministic.Effects();
  const Eigen::VectorXd values = deterministic.Values();
  if (stochastic != nullptr) return FitBeside(*stochastic, problem, metric, effects, values);
  return FitEffects(ErrorModelOf(problem.runs, problem.nominal.boat), metric, effects, {values});
}

}  // namespace telltale
