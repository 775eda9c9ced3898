#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/regression/parameter_block.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// One equation's part of a weak-form fit, over its supports in WeakProblem::supports.
/// Shapes: theta p; G and Z supports x p; residual, one per support. With V the covariance of the
/// residuals, theta = (Z'G)^-1 Z'b.
struct WeakEstimate {
  std::vector<std::size_t> columns;  ///< sought, of Regressors() and then RecordingBiasTerms
  Eigen::VectorXd theta;
  Eigen::VectorXd regularised;  ///< theta shrunk along directions that the data hardly determine
  Eigen::MatrixXd G;            ///< projected regressors, corrected for the filtering loss
  Eigen::MatrixXd Z;            ///< V^-1 times the projected instruments
  Eigen::VectorXd residual;
};

/// Delays between the channels, docs/concepts/model.md (36), in seconds: of the commands, of the
/// fixes, both against the headings.
struct DelayEstimates {
  Eigen::Vector2d delays_s = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// Shapes, with P the stacked unknowns (the time constant first if it is sought, then the
/// coefficients of each answered equation) and Q those and the delays, if they are sought: bread
/// P x Q, the rows of (Z'G)^-1 that belong to theta; scores Q x clusters, which sum to Z'e. Each
/// column holds the contribution of the whitened residuals of one cluster's supports.
/// theta - truth = bread Z'e, so Cov(theta) = bread Cov(sum of scores) bread'.
struct WeakFit {
  WeakProblem problem;
  std::array<std::optional<WeakEstimate>, 3> equations;
  std::optional<double> time_constant_s;
  std::optional<DelayEstimates> delays;  ///< where they are sought
  Eigen::VectorXd theta;
  Eigen::MatrixXd bread;
  Eigen::MatrixXd scores;
  /// P x P, Cov(theta) if the whitened residuals of each equation are stationary.
  Eigen::MatrixXd stationary_covariance;

  /// Where the coefficients of an answered equation stand among the stacked unknowns.
  Block BlockOf(std::size_t equation) const;
  /// The blocks of all stacked unknowns; that of the time constant comes first, if it is sought.
  std::vector<Block> Blocks() const;
  /// The stacked unknowns with the regularised coefficients in place of theta.
  Eigen::VectorXd Regularised() const;
};

/// The model that stacked unknowns of such a fit describe. Coefficients not sought are zero: where
/// each recording has a constant disturbance of its own, the model has none.
VesselModel ModelOf(const WeakFit& fit, const Eigen::VectorXd& theta, double sampling_period_s);

/// Whether the time constant stands at the lower limit of the search: the data show no lag.
bool LagIsAtLowerBound(const WeakFit& fit);

}  // namespace telltale
