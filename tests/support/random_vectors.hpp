#pragma once

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// Independent standard normal numbers.
inline FossenVector DrawnVector(WhiteSource& white) {
  FossenVector z;
  for (double& value : z) value = white();
  return z;
}

}  // namespace telltale
