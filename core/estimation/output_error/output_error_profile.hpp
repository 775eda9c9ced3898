#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/output_error.hpp"
#include "telltale/core/estimation/output_error/shooting_solution.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// The profile likelihood of each unknown of an output-error fit, docs/concepts/model.md (56): the
/// sum of squares with that unknown held at a value and all others, and the initial states, fitted
/// again. Where the model is strongly nonlinear within the width of a bound, the profile is
/// asymmetric: an interval of one standard error times a quantile is then too wide on one side and
/// too narrow on the other. Assumes: dataset and fit outlive it.
class OutputErrorProfile {
 public:
  /// Requires: `fit` to be what EstimateOutputError gave for the same other arguments.
  OutputErrorProfile(const PreparedDataset& dataset, const RegressionOptions& regression,
                     const OutputErrorFit& fit, const OutputErrorOptions& options);
  OutputErrorProfile(const OutputErrorProfile&) = delete;
  OutputErrorProfile& operator=(const OutputErrorProfile&) = delete;

  /// The asymmetry of the profile at `half_width` to either side, to third order and on a sample of
  /// the shooting segments: the ratio of the half widths. One if symmetric; infinite where the
  /// simulation diverges on the way.
  double Asymmetry(Eigen::Index unknown, double half_width) const;

  /// The rise of the sum of squares over the variance of residuals when `unknown` is held at
  /// `value`: about ((value - estimate) / standard error)^2, the naive one, near the estimate.
  /// Greater than any threshold where the simulation diverges.
  double Deviance(Eigen::Index unknown, double value) const;

 private:
  /// A shooting segment to first order about the least sum, its initial state fitted to theta.
  struct Linearised {
    std::size_t shooting_segment = 0;
    Eigen::VectorXd residual;
    Eigen::MatrixXd by_theta;        ///< n x P
    Eigen::MatrixXd start_by_theta;  ///< 6 x P
  };

  /// A step of this unknown with the step of all others that fits best, to first order.
  Eigen::VectorXd StepOf(Eigen::Index unknown, double step) const;

  const OutputErrorFit& fit_;
  ShootingPlan plan_;
  RidgePrior ridge_prior_;
  NoiseScale noise_scale_;
  ShootingSolution optimum_;
  double optimum_sum_ = 0.0;
  Eigen::MatrixXd naive_;
  std::vector<Linearised> sample_;
};

}  // namespace telltale
