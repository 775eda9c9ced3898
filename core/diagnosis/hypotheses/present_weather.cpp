#include "telltale/core/diagnosis/hypotheses/present_weather.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/refit.hpp"

namespace telltale {
namespace {

bool IsWeather(const ModelledEffect& modelled) {
  return modelled.effect->Facts().is_weather;
}

/// What the sizes of effects do to the errors, one prior standard deviation a column.
Eigen::MatrixXd FreeSizes(const std::vector<const Effect*>& effects,
                          const DiagnosisProblem& problem) {
  std::vector<Eigen::Index> columns;
  for (const Effect* effect : effects) {
    std::ranges::copy(ColumnsOf(*effect, problem.parameter_refs), std::back_inserter(columns));
  }
  return kDiagnosis.effect_fit.prior_width *
         problem.recording.by_effect_parameter(Eigen::all, columns);
}

double ReducedChiSquareOf(const Eigen::MatrixXd& errors, const ResidualMetric& metric) {
  return metric.ReducedChiSquare(metric.Whiten(errors));
}

/// `fit`: of effects of weather alone.
PresentWeather PresentWeatherOf(const EffectFit& fit, const DiagnosisProblem& problem) {
  const ResidualMetric widened = fit.WidenedMetric(problem.metric);
  const double explained = ReducedChiSquareOf(problem.recording.errors, problem.metric) -
                           ReducedChiSquareOf(fit.errors, widened);
  return {widened.WithFree(FreeSizes(fit.Effects(), problem)), fit, std::max(explained, 0.0)};
}

/// The weather of `hypothesis`, less one effect.
PresentWeather PresentWeatherOf(const EffectFit& hypothesis, const Effect* less,
                                const DiagnosisProblem& problem) {
  EffectFit weather = hypothesis;
  std::erase_if(weather.effects, [&](const ModelledEffect& modelled) {
    return !IsWeather(modelled) || modelled.effect == less;
  });
  if (weather.effects.empty()) return {problem.metric};
  const bool is_whole = weather.effects.size() == hypothesis.effects.size();
  return PresentWeatherOf(is_whole ? hypothesis : Refit(weather, problem, problem.metric), problem);
}

}  // namespace

WeatherBeside::WeatherBeside(const EffectFit& hypothesis, const DiagnosisProblem& problem)
    : all_(PresentWeatherOf(hypothesis, nullptr, problem)) {
  for (const Effect* effect : all_.fit.Effects()) {
    less_.emplace(effect, PresentWeatherOf(all_.fit, effect, problem));
  }
}

const PresentWeather& WeatherBeside::Of(const Effect& effect) const {
  const auto own = less_.find(&effect);
  return own == less_.end() ? all_ : own->second;
}

DiagnosisProblem InWeather(const DiagnosisProblem& problem, const PresentWeather& weather) {
  return {problem.runs,   problem.nominal,        problem.recording,
          weather.metric, problem.parameter_refs, problem.excitation};
}

}  // namespace telltale
