#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// Whitens autocorrelated residuals: W with W V W' = 1, V the covariance of an autoregressive
/// process, W lower triangular. Each whitened residual is the scaled innovation, the residual less
/// its linear prediction from those before it. W'W = V^-1, so least squares of whitened sides is
/// generalised least squares of the sides themselves. The first residuals of a run are predicted
/// from as many as precede them. Different runs are uncorrelated.
/// Source: Durbin, "The fitting of time-series models", Revue de l'Institut International de
/// Statistique 28 (1960).
class ResidualWhitening {
 public:
  /// `autocovariance` by lag, positive semidefinite as of DefiniteAutocovariance(). The order of
  /// the process is one less than the number of lags. W is the identity where the variance is zero
  /// or not finite.
  ResidualWhitening(std::vector<RowRange> runs, const Eigen::VectorXd& autocovariance);

  /// W X. Shapes: X and the result residuals x any number of columns.
  Eigen::MatrixXd Whiten(const Eigen::MatrixXd& X) const;

  /// W'X, likewise.
  Eigen::MatrixXd WhitenBack(const Eigen::MatrixXd& X) const;

 private:
  /// Predicts a residual from those 1, 2, ... before it; `deviation` is the standard error.
  struct LinearPredictor {
    Eigen::VectorXd weights;
    double deviation = 1.0;
  };

  /// Neighbours in a run that have the same predictor.
  struct PredictedRange {
    Eigen::Index begin = 0;
    Eigen::Index size = 0;
    const LinearPredictor& by;
  };

  template <typename Visit>  // Visit(const PredictedRange&)
  void ForEachPredictedRange(const Visit& visit) const;

  std::vector<RowRange> runs_;
  std::vector<LinearPredictor> predictors_;  ///< by the number of preceding residuals
};

}  // namespace telltale
