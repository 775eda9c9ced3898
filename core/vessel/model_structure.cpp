#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

std::string_view Name(Structure structure) {
  switch (structure) {
    case Structure::kStaticQuadratic: return "STATIC_QUADRATIC";
    case Structure::kFirstOrderDynamic: return "FIRST_ORDER_DYNAMIC";
    case Structure::kFossen: return "FOSSEN";
    case Structure::kUnknown: break;
  }
  return "UNKNOWN";
}

std::string_view Name(Parameterization parameterization) {
  switch (parameterization) {
    case Parameterization::kPropeller: return "PROPELLER";
    case Parameterization::kPaper: return "PAPER";
    case Parameterization::kUnknown: break;
  }
  return "UNKNOWN";
}

}  // namespace telltale
