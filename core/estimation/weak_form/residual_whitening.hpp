#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// What is new in each residual of a run, beyond what those before it foretell: W with W V W' = 1,
/// V the covariance of an autoregressive process, W lower triangular. So W'W = V^-1, and least
/// squares of whitened sides are generalised least squares of the sides themselves. The first
/// residuals of a run are foretold by as many as there are; runs know nothing of each other.
/// Source: Durbin, "The fitting of time-series models", Revue de l'Institut International de
/// Statistique 28 (1960).
class ResidualWhitening {
 public:
  /// `autocovariance` by lag, from which Correlate makes no negative variance; the process is of an
  /// order one less than it has lags. It changes nothing where the variance is zero or no number.
  ResidualWhitening(std::vector<RowRange> runs, const Eigen::VectorXd& autocovariance);

  /// W X. Shapes: X and the result residuals x any number of columns.
  Eigen::MatrixXd Whiten(const Eigen::MatrixXd& X) const;

  /// W'X, likewise.
  Eigen::MatrixXd WhitenBack(const Eigen::MatrixXd& X) const;

 private:
  /// How a residual is foretold from those 1, 2, ... before it, and by how much that errs.
  struct LinearPredictor {
    Eigen::VectorXd weights;
    double deviation = 1.0;
  };

  /// Neighbours in a run that are foretold alike.
  struct PredictedRange {
    Eigen::Index begin = 0;
    Eigen::Index size = 0;
    const LinearPredictor& by;
  };

  template <typename Visit>  // Visit(const PredictedRange&)
  void ForEachPredictedRange(const Visit& visit) const;

  std::vector<RowRange> runs_;
  std::vector<LinearPredictor> predictors_;  ///< by how many residuals of the run come before
};

}  // namespace telltale
