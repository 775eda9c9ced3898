#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "telltale/core/vessel/body_regressors.hpp"
#include "telltale/core/vessel/equation.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// One column of a regression: its name in published files, the coefficient's symbol, its SI unit.
struct Regressor {
  std::string_view name;
  std::string_view symbol;
  std::string_view unit;
  bool is_propeller = false;
};

/// The columns of Phi_j, body regressors first.
/// Model: nu_dot_j = Phi_j(nu, delta) theta_j for j in {surge, sway, yaw}, linear in theta_j;
/// docs/concepts/model.md (10)..(12).
std::span<const Regressor> Regressors(Equation equation, Parameterization parameterization);

/// How many of Regressors() belong to the body; the propeller regressors follow them.
std::size_t BodyRegressors(Equation equation);

/// The propeller regressors of a command: those of surge, and those that sway and yaw share. Unused
/// entries are zero.
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

/// The same from given propeller regressors, lagged ones for instance.
void FillRow(Equation equation, const Nu& nu, const ThrustRegressors& thrust,
             std::span<double> row);

/// The same from given body and propeller regressors.
void FillRow(Equation equation, const BodyRow& body, const ThrustRegressors& thrust,
             std::span<double> row);

}  // namespace telltale
