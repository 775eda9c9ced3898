#include "telltale/client/cli/coefficient_text.hpp"

#include <cctype>
#include <utility>

namespace telltale {
namespace {

std::string EquationHeading(Equation equation) {
  switch (equation) {
    case Equation::kSurge: return "SURGE  du/dt";
    case Equation::kSway: return "SWAY   dv/dt";
    case Equation::kYaw: return "YAW    dr/dt";
    case Equation::kUnknown: break;
  }
  return "";
}

}  // namespace

std::string InWords(std::string_view name) {
  std::string words;
  for (const char c : name) {
    words += c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return words;
}

std::string BoundsTitle(const Identification& identification) {
  if (identification.coefficients.empty()) return "bounds";
  return Plain(100.0 * identification.coefficients.front().interval.level) + " % bounds";
}

std::string BoundsText(const Interval& interval, double scale) {
  return '[' + Significant(scale * interval.lower) + ", " + Significant(scale * interval.upper) +
         ']';
}

std::string CoefficientRows(
    const Identification& identification, std::vector<Column> columns,
    const std::function<std::vector<std::string>(const Coefficient&, std::size_t)>& cells) {
  Table table(std::move(columns));
  for (const Equation equation : kEquations) {
    if (!identification.Has(equation)) continue;
    table.AddHeading(EquationHeading(equation));
    for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
      const Coefficient& coefficient = identification.coefficients[i];
      if (coefficient.equation == equation) table.AddRow(cells(coefficient, i));
    }
  }
  return table.Render();
}

}  // namespace telltale
