#pragma once

#include <string>
#include <vector>

#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// The bounds of one coefficient now and once a manoeuvre is part of the data.
struct ExpectedBounds {
  Equation equation = Equation::kUnknown;
  std::string regressor;
  std::string unit;
  double estimate = 0.0;
  double half_width = 0.0;           ///< of the interval now; infinite where not known
  double expected_half_width = 0.0;  ///< with the manoeuvre in the data; likewise
};

/// A manoeuvre that narrows the bounds of ill-determined coefficients.
struct ManoeuvreAdvice {
  std::string manoeuvre;
  std::string how;
  double duration_s = 0.0;
  double expected_nats = 0.0;            ///< information about those coefficients, (66)
  std::vector<ExpectedBounds> expected;  ///< of those coefficients, the narrowest ratio first
};

}  // namespace telltale
