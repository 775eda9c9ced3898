#pragma once

#include <span>
#include <vector>

#include "telltale/core/effects/effect.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// A boat's model together with effects that it leaves out.
struct AugmentedModel {
  VesselModel model;
  std::vector<ModelledEffect> effects;  ///< none: the model alone

  /// The same boat with more effects.
  AugmentedModel With(std::span<const ModelledEffect> more) const {
    AugmentedModel with = *this;
    with.effects.insert(with.effects.end(), more.begin(), more.end());
    return with;
  }
};

}  // namespace telltale
