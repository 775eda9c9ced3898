#pragma once

#include <Eigen/Core>

#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// The physical form as matrices over m11, rows and columns in the order surge, sway, yaw.
/// Model: docs/concepts/physical-model.md (101)..(103), D(nu) = linear_damping + u lift_damping +
/// quadratic_damping diag(|nu|) + diag(cross_flow_damping |nu|).
struct FossenMatrices {
  Eigen::Matrix3d mass;
  Eigen::Matrix3d linear_damping;
  Eigen::Matrix3d lift_damping;
  Eigen::Matrix3d quadratic_damping;
  Eigen::Matrix3d cross_flow_damping;
};

FossenMatrices MatricesOf(const FossenVector& parameters);

}  // namespace telltale
