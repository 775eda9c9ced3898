#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/multiple_shooting_solution.hpp"
#include "telltale/core/estimation/output_error/output_error.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// The profile likelihood of each unknown of an output-error fit, docs/concepts/model.md (56): what
/// the sum of squares costs when that unknown is held elsewhere and all others, and the states of
/// the shots, are fitted anew. Where the model is far from linear over the reach of a bound it
/// rises faster on one side than on the other, and a bound of one standard error times a quantile
/// says too much of one side and too little of the other. Assumes: dataset and fit outlive it.
class OutputErrorProfile {
 public:
  /// Requires: `fit` to be what EstimateOutputError gave for the same other arguments.
  OutputErrorProfile(const PreparedDataset& dataset, const RegressionOptions& regression,
                     const OutputErrorFit& fit, const OutputErrorOptions& options);
  OutputErrorProfile(const OutputErrorProfile&) = delete;
  OutputErrorProfile& operator=(const OutputErrorProfile&) = delete;

  /// How lopsided the profile is at `reach` to either side, cheaply: to third order, at some of
  /// the shots. One if not at all; infinite where the boat runs away on the way.
  double Asymmetry(Eigen::Index unknown, double half_width) const;

  /// The rise of the sum of squares over the variance of residuals when `unknown` is held at
  /// `value`: about ((value - estimate) / standard error)^2, the naive one, near the estimate.
  /// More than any threshold where the boat runs away.
  double Deviance(Eigen::Index unknown, double value) const;

 private:
  /// A shot to first order about the least sum, its state following theta.
  struct Linear {
    std::size_t shooting_segment = 0;
    Eigen::VectorXd residual;
    Eigen::MatrixXd by_theta;        ///< n x P
    Eigen::MatrixXd start_by_theta;  ///< 6 x P
  };

  /// The others as they follow a step of this unknown, to first order.
  Eigen::VectorXd Follow(Eigen::Index unknown, double step) const;

  const OutputErrorFit& fit_;
  ShootingPlan plan_;
  RidgePrior ridge_prior_;
  NoiseScale noise_scale_;
  ShootingSolution optimum_;
  double optimum_sum_ = 0.0;
  Eigen::MatrixXd naive_;
  std::vector<Linear> sample_;
};

}  // namespace telltale
