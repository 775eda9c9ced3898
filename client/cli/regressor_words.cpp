#include "telltale/client/cli/regressor_words.hpp"

#include <algorithm>
#include <array>

#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {
namespace {

struct NamedRegressor {
  std::string_view regressor;
  std::string_view words;
};

constexpr std::array kWords = {
    NamedRegressor{"u|u|", "surge, quadratic"},
    NamedRegressor{"v|v|", "sway, quadratic"},
    NamedRegressor{"r|r|", "yaw rate, quadratic"},
    NamedRegressor{"u", "surge, linear"},
    NamedRegressor{"v", "sway, linear"},
    NamedRegressor{"r", "yaw rate, linear"},
    NamedRegressor{"vr", "sway times yaw rate"},
    NamedRegressor{"rr", "yaw rate squared"},
    NamedRegressor{"v|r|", "sway times |yaw rate|"},
    NamedRegressor{"r|v|", "yaw rate times |sway|"},
    NamedRegressor{"uv", "surge times sway"},
    NamedRegressor{"ur", "surge times yaw rate"},
    NamedRegressor{"1", "constant disturbance"},
    NamedRegressor{"cos(psi)", "constant push, north"},
    NamedRegressor{"sin(psi)", "constant push, east"},
    NamedRegressor{"f:d^2", "forward thrust, quadratic"},
    NamedRegressor{"f:d", "forward thrust, linear"},
    NamedRegressor{"r:d^2", "reverse thrust, quadratic"},
    NamedRegressor{"r:d", "reverse thrust, linear"},
    NamedRegressor{"mean^2+diff^2/4", "thrust, quadratic"},
    NamedRegressor{"mean", "thrust, linear"},
    NamedRegressor{"mean*diff", "difference, quadratic"},
    NamedRegressor{"diff/2", "difference, linear"},
};

struct OwnVelocity {
  Equation equation;
  std::string_view linear;
  std::string_view quadratic;
};

constexpr std::array kOwnVelocities = {OwnVelocity{Equation::kSurge, "u", "u|u|"},
                                       OwnVelocity{Equation::kSway, "v", "v|v|"},
                                       OwnVelocity{Equation::kYaw, "r", "r|r|"}};

std::string SymbolAndWords(std::string_view symbol, std::string_view words) {
  constexpr std::size_t kSymbolColumns = 6;
  std::string cell(symbol);
  cell.resize(std::max(cell.size() + 1, kSymbolColumns), ' ');
  return cell.append(words);
}

}  // namespace

std::string_view RegressorInWords(Equation equation, std::string_view regressor) {
  for (const OwnVelocity& own : kOwnVelocities) {
    if (own.equation != equation) continue;
    if (own.linear == regressor) return "damping, linear";
    if (own.quadratic == regressor) return "damping, quadratic";
  }
  const auto found = std::find_if(kWords.begin(), kWords.end(), [&](const NamedRegressor& named) {
    return named.regressor == regressor;
  });
  return found == kWords.end() ? "" : found->words;
}

std::string RegressorCell(Equation equation, std::string_view regressor) {
  return SymbolAndWords(regressor, RegressorInWords(equation, regressor));
}

std::string ParameterCell(std::string_view symbol) {
  const auto found =
      std::ranges::find(FossenParameterNames(), symbol, &FossenParameterName::symbol);
  return found == FossenParameterNames().end() ? std::string(symbol)
                                               : SymbolAndWords(symbol, found->meaning);
}

}  // namespace telltale
