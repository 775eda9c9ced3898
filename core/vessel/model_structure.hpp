#pragma once

#include <array>
#include <span>
#include <string_view>

#include "telltale/core/vessel/body_regressors.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

enum class Equation { kUnknown, kSurge, kSway, kYaw };

inline constexpr std::array kEquations = {Equation::kSurge, Equation::kSway, Equation::kYaw};

/// Position of an equation in arrays ordered surge, sway, yaw.
std::size_t IndexOf(Equation equation);

/// The velocity that an equation is about: u, v or r.
double ComponentOf(const Nu& nu, Equation equation);

/// How thrust follows the command: at once, or through a first-order lag.
enum class Structure { kUnknown, kStaticQuadratic, kFirstOrderDynamic };

/// How the propeller part is written. kPaper follows the paper's mean and difference regressors;
/// kPropeller sums over the two propellers and is consistent in all four regions.
enum class Parameterization { kUnknown, kPropeller, kPaper };

/// One column of a regression: its name in published files, the coefficient's symbol, its SI unit.
struct Regressor {
  std::string_view name;
  std::string_view symbol;
  std::string_view unit;
  bool is_propeller = false;
};

/// Model: nu_dot_j = Phi_j(nu, delta) theta_j for j in {surge, sway, yaw}, linear in theta_j
/// (docs/concepts/model.md (10)..(12)). This is the list of the columns of Phi_j, body regressors
/// first.
std::span<const Regressor> Regressors(Equation equation, Parameterization parameterization);

/// How many of Regressors() belong to the body; the propeller regressors follow them.
std::size_t BodyRegressors(Equation equation);

/// The propeller regressors of a command: of surge, and those that sway and yaw share. Unused
/// places are zero.
struct ThrustRegressors {
  std::array<double, 4> surge{};
  std::array<double, 4> turning{};

  const std::array<double, 4>& Of(Equation equation) const {
    return equation == Equation::kSurge ? surge : turning;
  }
};

ThrustRegressors ThrustOf(Parameterization parameterization, const PropellerCommand& delta);

/// Writes the body part of the row Phi_j(nu, .), one value per body regressor.
void FillBody(Equation equation, const Nu& nu, std::span<double> row);

/// Writes the row Phi_j(nu, delta), one value per entry of Regressors(). `row` must be that long.
void FillRow(Equation equation, Parameterization parameterization, const Nu& nu,
             const PropellerCommand& delta, std::span<double> row);

/// The same with the propeller regressors at hand, lagged ones for instance.
void FillRow(Equation equation, const Nu& nu, const ThrustRegressors& thrust,
             std::span<double> row);

/// The same with those of the body at hand, too.
void FillRow(Equation equation, const BodyRow& body, const ThrustRegressors& thrust,
             std::span<double> row);

std::string_view Name(Equation equation);
std::string_view Name(Structure structure);
std::string_view Name(Parameterization parameterization);

}  // namespace telltale
