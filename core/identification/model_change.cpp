#include "telltale/core/identification/model_change.hpp"

#include <algorithm>
#include <cstdio>

namespace telltale {
namespace {

constexpr std::size_t kNamed = 3;

std::string Formatted(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string Earlier(const ModelChange& change) {
  return change.revision > 0 ? "revision " + std::to_string(change.revision) : "the other model";
}

std::string NameOf(const CoefficientChange& change) {
  if (change.equation == Equation::kUnknown) {
    return change.symbol == "tau" ? "thruster time constant" : change.symbol;
  }
  return std::string(Name(change.equation)) + ' ' + change.regressor;
}

std::string MostSignificant(const std::vector<CoefficientChange>& changes) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, changes.size()); ++i) {
    text += ", " + NameOf(changes[i]) + " by " + Formatted("%+.1f", changes[i].Sigmas()) + " sigma";
  }
  return text;
}

}  // namespace

std::string_view Name(ChangeVerdict verdict) {
  switch (verdict) {
    case ChangeVerdict::kNoSignificantChange: return "ALIKE";
    case ChangeVerdict::kChanged: return "DIFFERS";
    case ChangeVerdict::kInconclusive: return "CANNOT_TELL";
    case ChangeVerdict::kUnknown: break;
  }
  return "UNKNOWN";
}

std::string InWords(const ModelChange& change) {
  const std::string p = "p = " + Formatted("%.2g", change.p_value);
  switch (change.verdict) {
    case ChangeVerdict::kChanged:
      return "differs from " + Earlier(change) + ": " + p + MostSignificant(change.coefficients) +
             "; fouling, damage or another load?";
    case ChangeVerdict::kNoSignificantChange:
      return "is no different from " + Earlier(change) + ": " + p;
    case ChangeVerdict::kInconclusive:
      return "cannot be compared with " +
             (change.revision > 0 ? Earlier(change) : "earlier models") + ": " + change.reason;
    case ChangeVerdict::kUnknown: break;
  }
  return "was not compared";
}

}  // namespace telltale
