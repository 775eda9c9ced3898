#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"

#include <algorithm>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr double kDerivativeStep = 0.05;  // of scaled values

}  // namespace

EffectParameters::EffectParameters(const std::vector<const Effect*>& effects) : effects_(effects) {
  for (const Effect* effect : effects) {
    for (const EffectParameter& parameter : effect->Parameters()) parameters_.push_back(&parameter);
  }
  lower_.resize(Size());
  upper_.resize(Size());
  for (Eigen::Index i = 0; i < Size(); ++i) {
    lower_[i] = ScaledAt(i, At(i).lower);
    upper_[i] = ScaledAt(i, At(i).upper);
  }
}

Eigen::Index EffectParameters::FirstOf(const Effect& effect) const {
  return std::ranges::find(parameters_, &effect.Parameters().front()) - parameters_.begin();
}

void EffectParameters::Bound(const Effect& effect, double lower, double upper) {
  const Eigen::Index i = FirstOf(effect);
  lower_[i] = ScaledAt(i, lower);
  upper_[i] = ScaledAt(i, upper);
}

Eigen::VectorXd EffectParameters::Scaled(const Eigen::VectorXd& values) const {
  Eigen::VectorXd scaled(Size());
  for (Eigen::Index i = 0; i < Size(); ++i) scaled[i] = ScaledAt(i, values[i]);
  return Clamped(scaled);
}

Eigen::VectorXd EffectParameters::Clamped(const Eigen::VectorXd& scaled) const {
  return scaled.cwiseMax(lower_).cwiseMin(upper_);
}

std::vector<ModelledEffect> EffectParameters::Effects(const Eigen::VectorXd& scaled) const {
  std::vector<ModelledEffect> modelled;
  Eigen::Index i = 0;
  for (const Effect* effect : effects_) {
    ModelledEffect& one = modelled.emplace_back(ModelledEffect{effect, {}});
    for (std::size_t j = 0; j < effect->Parameters().size(); ++j, ++i) {
      one.values.push_back(At(i).prior_mean + At(i).typical * scaled[i]);
    }
  }
  return modelled;
}

Eigen::VectorXd EffectParameters::PriorInformation() const {
  constexpr double kWidth = kDiagnosis.effect_fit.prior_width;
  Eigen::VectorXd information(Size());
  for (Eigen::Index i = 0; i < Size(); ++i) {
    information[i] = At(i).is_shape ? 1.0 : 1.0 / (kWidth * kWidth);
  }
  return information;
}

double EffectParameters::DerivativeStep(Eigen::Index i, double scaled) const {
  return scaled + kDerivativeStep > upper_[i] ? -kDerivativeStep : kDerivativeStep;
}

Eigen::VectorXd EffectParameters::TypicalSizes() const {
  Eigen::VectorXd sizes(Size());
  for (Eigen::Index i = 0; i < Size(); ++i) sizes[i] = At(i).typical;
  return sizes;
}

}  // namespace telltale
