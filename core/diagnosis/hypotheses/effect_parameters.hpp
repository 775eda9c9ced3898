#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// The parameters of effects that act together, as one scaled vector.
/// Shapes and units: one entry per parameter, stacked in the order of the effects. A scaled entry
/// is (value - prior mean) / typical size, so that priors are of order one.
class EffectParameters {
 public:
  explicit EffectParameters(const std::vector<const Effect*>& effects);

  /// The first parameter of one effect within these bounds, in its unit, rather than in its own.
  void Bound(const Effect& effect, double lower, double upper);

  Eigen::Index Size() const { return static_cast<Eigen::Index>(parameters_.size()); }

  /// The place of the first parameter of one of the effects.
  Eigen::Index FirstOf(const Effect& effect) const;

  /// Values in their own units to scaled ones, within the bounds of each parameter.
  Eigen::VectorXd Scaled(const Eigen::VectorXd& values) const;

  Eigen::VectorXd Clamped(const Eigen::VectorXd& scaled) const;

  /// The effects at scaled values.
  std::vector<ModelledEffect> Effects(const Eigen::VectorXd& scaled) const;

  /// Diagonal of the prior information, docs/concepts/diagnosis.md (88): standard deviation one for
  /// a shape parameter, kDiagnosis.effect_fit.prior_width for any other.
  Eigen::VectorXd PriorInformation() const;

  /// Step of a finite difference from `scaled`, away from the upper bound where that is near.
  double DerivativeStep(Eigen::Index i, double scaled) const;

  Eigen::VectorXd TypicalSizes() const;

 private:
  const EffectParameter& At(Eigen::Index i) const {
    return *parameters_[static_cast<std::size_t>(i)];
  }

  double ScaledAt(Eigen::Index i, double value) const {
    return (value - At(i).prior_mean) / At(i).typical;
  }

  std::vector<const Effect*> effects_;
  std::vector<const EffectParameter*> parameters_;
  Eigen::VectorXd lower_;  ///< scaled
  Eigen::VectorXd upper_;
};

}  // namespace telltale
