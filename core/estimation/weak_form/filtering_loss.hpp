#pragma once

#include <span>

#include <Eigen/Core>

#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// Body velocities and heading that a model predicts for one row.
struct PredictedInstant {
  Nu nu;
  double psi_rad = 0.0;
};

/// What filtering before multiplying removes from the body regressors: products of filtered
/// velocities are not filtered products. Zero where Phi is linear in nu.
class FilteringLoss {
 public:
  /// `predicted`: consecutive rows. `kernel`: the smoothing filter F on intervals.
  FilteringLoss(std::span<const PredictedInstant> predicted, const Eigen::VectorXd& kernel);

  /// int phi (F Phi(nu) - Phi(F nu)) dt over the support that begins at this row, a value per body
  /// regressor of surge, or of sway and yaw. `smoothed`: phi convolved with F.
  Eigen::RowVectorXd Over(Eigen::Index first, bool surge, const Eigen::VectorXd& smoothed,
                          const Eigen::VectorXd& phi) const;

 private:
  template <int Columns>
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Columns, Eigen::RowMajor>;

  Rows<5> surge_;             ///< between rows
  Rows<9> turning_;           ///< between rows
  Rows<5> filtered_surge_;    ///< of the filtered velocities
  Rows<9> filtered_turning_;  ///< of the filtered velocities
  Eigen::Index half_width_;
};

}  // namespace telltale
