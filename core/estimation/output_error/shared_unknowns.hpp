#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/estimation/output_error/separability.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// The unknowns that all shooting segments share, stacked: the thruster time constant if it is
/// sought, then the sought coefficients of surge, sway and yaw.
struct SharedUnknowns {
  Parameterization parameterization = Parameterization::kUnknown;
  DeadZone dead_zone;
  bool lagging = false;
  std::array<std::vector<std::size_t>, 3> columns;  ///< of Regressors(), ascending, by equation

  Eigen::Index Size() const;
  Eigen::Index First(Equation equation) const;  ///< place of an equation's first coefficient

  /// The model that they describe; coefficients not sought are zero.
  VesselModel ModelWith(const Eigen::VectorXd& theta, double sampling_period_s) const;

  /// Their values in a model of the same parameterization.
  Eigen::VectorXd In(const VesselModel& model) const;
};

/// "SURGE u|u|", "thruster time constant": the unknown at a place in theta.
std::string NameOf(const SharedUnknowns& unknowns, std::size_t unknown);

/// A refusal that tells an operator what an inseparable direction means and what to record.
Refusal Explain(const InseparableDirection& direction, const SharedUnknowns& unknowns);

}  // namespace telltale
