#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "telltale/core/estimation/weak_form/filtering_loss.hpp"
#include "telltale/core/estimation/weak_form/test_function.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"
#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// How delays between the channels enter the projected equations, to first order,
/// docs/concepts/model.md (36): commands act d_c after their stamps, fixes are stamped d_f after
/// the boat was there, both by the clock of the headings. Then
///   b = G theta + d_c int phi' tau dt + d_f (int phi' a dt + int phi (dF/dnu) a dt)
/// with tau the acceleration by the propellers, F that by the water, and a = (u' - v r, v' + u r,
/// 0) the inertial acceleration of the boat in the body frame. Assumes: delays short beside the
/// motion.
class DelayDerivatives {
 public:
  static constexpr Eigen::Index kDelays = 2;  ///< of the commands, of the fixes

  /// `predicted`: consecutive rows, two or more; `thrust`: that of the same rows.
  DelayDerivatives(const BodyDynamics& dynamics, std::span<const PredictedInstant> predicted,
                   std::span<const ThrustRegressors> thrust, double sampling_period_s);

  /// The two derivatives in one equation, over the support that begins at this row.
  Eigen::RowVector2d Over(Eigen::Index first, std::size_t equation, const TestFunction& phi) const;

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;  ///< columns surge, sway, yaw

  Rows propelled_;
  Rows inertial_;  ///< a
  Rows carried_;   ///< (dF/dnu) a
};

}  // namespace telltale
