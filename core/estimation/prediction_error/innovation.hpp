#pragma once

#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// One innovation, a scalar: the reading less its prediction from all readings before it.
struct Innovation {
  double time_s = 0.0;
  double value = 0.0;
  double variance = 0.0;
};

/// How an innovation changes with the parameters.
struct InnovationSlope {
  FossenVector slope;  ///< d value / d parameters at fixed gains
  /// The slope that the commands alone give: that of a boat without disturbance on the same
  /// headings. Equal to the slope unless asked for.
  FossenVector instrument;
};

}  // namespace telltale
