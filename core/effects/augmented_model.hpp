#pragma once

#include <vector>

#include "effects/effect.hpp"
#include "vessel/vessel_model.hpp"

namespace telltale {

/// A boat's model together with effects that it leaves out.
struct AugmentedModel {
  VesselModel model;
  std::vector<ModelledEffect> effects;  ///< none: the model alone
};

}  // namespace telltale
