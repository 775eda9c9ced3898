#include "telltale/core/vessel/equation.hpp"

#include "telltale/core/base/contract.hpp"

namespace telltale {

std::size_t IndexOf(Equation equation) {
  Require(equation != Equation::kUnknown, "a named equation");
  return static_cast<std::size_t>(equation) - 1;
}

double ComponentOf(const Nu& nu, Equation equation) {
  switch (equation) {
    case Equation::kSurge: return nu.u;
    case Equation::kSway: return nu.v;
    case Equation::kYaw: return nu.r;
    case Equation::kUnknown: break;
  }
  throw ContractViolation("ComponentOf: requires a named equation");
}

std::string_view Name(Equation equation) {
  switch (equation) {
    case Equation::kSurge: return "SURGE";
    case Equation::kSway: return "SWAY";
    case Equation::kYaw: return "YAW";
    case Equation::kUnknown: break;
  }
  return "UNKNOWN";
}

}  // namespace telltale
