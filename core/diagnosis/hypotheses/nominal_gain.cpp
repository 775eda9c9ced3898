#include "telltale/core/diagnosis/hypotheses/nominal_gain.hpp"

#include <algorithm>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/score_test.hpp"

namespace telltale {

std::map<const Effect*, double> NominalGains(const DiagnosisProblem& problem,
                                             std::span<const Effect* const> library) {
  std::map<const Effect*, double> gains;
  for (const Effect* effect : library) gains[effect] = 0.0;
  for (const Sensitivity& day : problem.nominal.days) {
    const ResidualMetric metric(problem.nominal, day, EveryWindow(day),
                                problem.metric.FreesCoefficients());
    for (auto& [effect, gain] : gains) {
      if (effect->IsStochastic()) continue;
      const double score = ScoreTest(*effect, metric, day.errors, day, problem.parameter_refs);
      const double ratio = problem.metric.EffectiveObservations() / metric.EffectiveObservations();
      gain = std::max(gain, -kDiagnosis.search.nominal_gain_factor * ratio * score);
    }
  }
  return gains;
}

}  // namespace telltale
