#include "telltale/core/identification/coefficient.hpp"

namespace telltale {

std::string_view Name(CoefficientStatus status) {
  switch (status) {
    case CoefficientStatus::kEstimated: return "ESTIMATED";
    case CoefficientStatus::kNotExcited: return "NOT_EXCITED";
    case CoefficientStatus::kCollinear: return "COLLINEAR";
    case CoefficientStatus::kPrior: return "PRIOR";
    case CoefficientStatus::kUnknown: break;
  }
  return "UNKNOWN";
}

}  // namespace telltale
