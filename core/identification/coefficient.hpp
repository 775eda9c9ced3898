#pragma once

#include <string>
#include <string_view>

#include "telltale/core/uncertainty/interval.hpp"
#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// kEstimated: the data give estimate and bounds.
/// kNotExcited: the data do not excite this regressor; the estimate is 0, standard error and bounds
/// are infinite.
/// kCollinear: the data excite the regressor only together with others. Its bounds hold, but it is
/// read together with the partners that a refusal names.
/// kPrior: of a physical parameter. The data narrow its prior by less than a fifth.
enum class CoefficientStatus { kUnknown, kEstimated, kNotExcited, kCollinear, kPrior };

std::string_view Name(CoefficientStatus status);

/// One coefficient with its bounds, continuous-time SI.
struct Coefficient {
  Equation equation = Equation::kUnknown;
  std::string regressor;
  std::string symbol;
  double estimate = 0.0;
  double standard_error = 0.0;
  Interval interval;
  std::string unit;
  CoefficientStatus status = CoefficientStatus::kUnknown;
};

}  // namespace telltale
