#pragma once

#include <map>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// The weather that a recording shows; whatever else acts has to show beside it,
/// docs/concepts/diagnosis.md (130).
struct PresentWeather {
  /// Allows for its waves, gusts and drifts, and for its sizes within their priors.
  ResidualMetric metric;
  EffectFit fit = {};   ///< of its effects alone; none in calm
  double excess = 0.0;  ///< reduced chi-square that it explains

  bool IsCalm() const { return fit.effects.empty(); }
};

/// The weather beside which each effect has to show: that of a hypothesis, less the effect itself.
/// The hypothesis' other effects are left out. The problem has to outlive it.
class WeatherBeside {
 public:
  WeatherBeside(const EffectFit& hypothesis, const DiagnosisProblem& problem);

  const PresentWeather& Of(const Effect& effect) const;
  std::vector<std::string> Names() const { return all_.fit.Names(); }

 private:
  PresentWeather all_;
  std::map<const Effect*, PresentWeather> less_;  ///< of each effect of the weather, the others
};

/// The problem by the metric that allows for the weather. Both have to outlive it.
DiagnosisProblem InWeather(const DiagnosisProblem& problem, const PresentWeather& weather);

}  // namespace telltale
