#include "telltale/core/diagnosis/residuals/sensitivity.hpp"

#include <cmath>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr double kNegligible = kDiagnosis.linearisation.negligible_size;  // of the typical size

Eigen::VectorXd Stacked(const Eigen::MatrixXd& errors) {
  return errors.reshaped();
}

AugmentedModel WithMore(AugmentedModel boat, const EffectParameterRef& parameter_ref,
                        double value) {
  for (ModelledEffect& there : boat.effects) {
    if (there.effect != parameter_ref.effect) continue;
    there.values[parameter_ref.parameter] += value;
    return boat;
  }
  boat.effects.push_back(At(parameter_ref, value));
  return boat;
}

}  // namespace

std::vector<EffectParameterRef> EffectParameterRefsOf(std::span<const Effect* const> effects) {
  std::vector<EffectParameterRef> parameter_refs;
  for (const Effect* effect : effects) {
    if (effect->IsStochastic()) continue;
    const auto parameters = effect->Parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (!parameters[i].is_shape) parameter_refs.push_back({effect, i});
    }
  }
  return parameter_refs;
}

std::vector<Eigen::Index> ColumnsOf(const Effect& effect,
                                    const std::vector<EffectParameterRef>& parameter_refs) {
  std::vector<Eigen::Index> columns;
  for (std::size_t j = 0; j < parameter_refs.size(); ++j) {
    if (parameter_refs[j].effect == &effect) columns.push_back(static_cast<Eigen::Index>(j));
  }
  return columns;
}

ModelledEffect At(const EffectParameterRef& parameter_ref, double value) {
  ModelledEffect modelled{parameter_ref.effect, {}};
  for (const EffectParameter& parameter : parameter_ref.effect->Parameters()) {
    modelled.values.push_back(parameter.prior_mean);
  }
  modelled.values[parameter_ref.parameter] = value;
  return modelled;
}

std::vector<ModelledEffect> EffectsOf(const std::vector<EffectParameterRef>& parameter_refs,
                                      const Eigen::VectorXd& sizes) {
  std::vector<ModelledEffect> effects;
  for (std::size_t j = 0; j < parameter_refs.size(); ++j) {
    const EffectParameterRef& parameter_ref = parameter_refs[j];
    const double value = parameter_ref.effect->Parameters()[parameter_ref.parameter].typical *
                         sizes[static_cast<Eigen::Index>(j)];
    if (std::abs(sizes[static_cast<Eigen::Index>(j)]) < kNegligible) continue;
    if (effects.empty() || effects.back().effect != parameter_ref.effect) {
      effects.push_back(At(parameter_ref, value));
    } else {
      effects.back().values[parameter_ref.parameter] = value;
    }
  }
  return effects;
}

Sensitivity SensitivityOf(const FreeRuns& runs, const ChangedBoat& about,
                          const UncertainModel& model,
                          const std::vector<EffectParameterRef>& parameter_refs,
                          std::size_t threads, double step) {
  const AugmentedModel& boat = about.boat;
  Sensitivity sensitivity;
  sensitivity.errors = runs.Errors(boat);
  const auto base = static_cast<Eigen::Index>(model.free.size());
  const auto size = sensitivity.errors.size();
  sensitivity.by_coefficient.resize(size, base);
  sensitivity.by_effect_parameter.resize(size, static_cast<Eigen::Index>(parameter_refs.size()));
  for (std::size_t w = 0; w < runs.Windows(); ++w) {
    sensitivity.window_times_s.push_back(runs.Of(w).time_s);
  }
  const Eigen::VectorXd nominal = Stacked(sensitivity.errors);
  const Eigen::VectorXd standard_errors = model.StandardErrors();
  ForEachIndex(model.free.size() + parameter_refs.size(), threads, [&](std::size_t i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (column < base) {
      const AugmentedModel changed{model.Changed(standard_errors.cwiseProduct(
                                       about.change + Eigen::VectorXd::Unit(base, column))),
                                   boat.effects};
      sensitivity.by_coefficient.col(column) = Stacked(runs.Errors(changed)) - nominal;
      return;
    }
    const EffectParameterRef& parameter_ref = parameter_refs[i - static_cast<std::size_t>(base)];
    const double typical = parameter_ref.effect->Parameters()[parameter_ref.parameter].typical;
    sensitivity.by_effect_parameter.col(column - base) =
        (Stacked(runs.Errors(WithMore(boat, parameter_ref, step * typical))) - nominal) / step;
  });
  return sensitivity;
}

}  // namespace telltale
