#include "telltale/core/diagnosis/sensitivity.hpp"

#include <cmath>

#include "telltale/core/parallel.hpp"

namespace telltale {
namespace {

constexpr double kNegligible = 0.02;  // of the typical size

Eigen::VectorXd Stacked(const Eigen::MatrixXd& errors) {
  return errors.reshaped();
}

AugmentedModel WithMore(AugmentedModel boat, const Slot& slot, double value) {
  for (ModelledEffect& there : boat.effects) {
    if (there.effect != slot.effect) continue;
    there.values[slot.parameter] += value;
    return boat;
  }
  boat.effects.push_back(At(slot, value));
  return boat;
}

}  // namespace

std::vector<Slot> SlotsOf(std::span<const Effect* const> effects) {
  std::vector<Slot> slots;
  for (const Effect* effect : effects) {
    if (effect->Shakes()) continue;
    const auto parameters = effect->Parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (!parameters[i].shapes) slots.push_back({effect, i});
    }
  }
  return slots;
}

ModelledEffect At(const Slot& slot, double value) {
  ModelledEffect modelled{slot.effect, {}};
  for (const EffectParameter& parameter : slot.effect->Parameters()) {
    modelled.values.push_back(parameter.usual);
  }
  modelled.values[slot.parameter] = value;
  return modelled;
}

std::vector<ModelledEffect> EffectsOf(const std::vector<Slot>& slots,
                                      const Eigen::VectorXd& sizes) {
  std::vector<ModelledEffect> effects;
  for (std::size_t j = 0; j < slots.size(); ++j) {
    const Slot& slot = slots[j];
    const double value =
        slot.effect->Parameters()[slot.parameter].typical * sizes[static_cast<Eigen::Index>(j)];
    if (std::abs(sizes[static_cast<Eigen::Index>(j)]) < kNegligible) continue;
    if (effects.empty() || effects.back().effect != slot.effect) {
      effects.push_back(At(slot, value));
    } else {
      effects.back().values[slot.parameter] = value;
    }
  }
  return effects;
}

Sensitivity SensitivityOf(const FreeRuns& runs, const AugmentedModel& boat,
                          const UncertainModel& model, const std::vector<Slot>& slots,
                          std::size_t threads, double step) {
  Sensitivity sensitivity;
  sensitivity.errors = runs.Errors(boat);
  const auto base = static_cast<Eigen::Index>(model.free.size());
  const auto size = sensitivity.errors.size();
  sensitivity.by_base.resize(size, base);
  sensitivity.by_slot.resize(size, static_cast<Eigen::Index>(slots.size()));
  const Eigen::VectorXd nominal = Stacked(sensitivity.errors);
  const Eigen::VectorXd standard_errors = model.StandardErrors();
  ForEachIndex(model.free.size() + slots.size(), threads, [&](std::size_t i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (column < base) {
      const AugmentedModel changed{
          model.Changed(boat.model, standard_errors[column] * Eigen::VectorXd::Unit(base, column)),
          boat.effects};
      sensitivity.by_base.col(column) = Stacked(runs.Errors(changed)) - nominal;
      return;
    }
    const Slot& slot = slots[i - static_cast<std::size_t>(base)];
    const double typical = slot.effect->Parameters()[slot.parameter].typical;
    sensitivity.by_slot.col(column - base) =
        (Stacked(runs.Errors(WithMore(boat, slot, step * typical))) - nominal) / step;
  });
  return sensitivity;
}

}  // namespace telltale
