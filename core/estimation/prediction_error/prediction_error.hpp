#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/prediction_error/fossen_prior.hpp"
#include "telltale/core/estimation/prediction_error/innovations.hpp"

namespace telltale {

struct PredictionErrorOptions {
  std::size_t threads = 1;
  int max_iterations = 25;
  double block_s = 10.0;  ///< length of the blocks behind the robust covariance
};

/// What the innovations of one block of time say.
struct ScoreBlock {
  FossenSquare information = FossenSquare::Zero();
  FossenVector score = FossenVector::Zero();
};

/// The fit of the physical form. Vectors and matrices in the order of FossenParameter.
struct PredictionErrorFit {
  FossenVector parameters;
  std::vector<NoiseModel> noise;  ///< by recording
  Eigen::VectorXd newton_mean;    ///< the minimum of the quadratic model without physical ranges
  Eigen::MatrixXd information;    ///< of data and prior
  Eigen::MatrixXd data_information;
  std::vector<ScoreBlock> blocks;              ///< of the data, by time
  Eigen::MatrixXd recording_score_covariance;  ///< of the data's score, by recordings
  std::size_t innovations = 0;
  int iterations = 0;
  bool converged = false;
};

/// The parameters at which the innovations of an extended Kalman filter are orthogonal to their
/// slopes, prior included: a prediction-error method, docs/concepts/physical-model.md (110)..(112).
/// The current and the misalignment of the compass are states of the filter, so that each recording
/// has its own; so is its noise, which maximises the likelihood.
/// The slopes are those at fixed gains. They depend on earlier readings alone, so that the
/// equations stay unbiased whatever the gains are. Source: Ljung, System Identification, 2nd
/// ed., 7.2 and 7.4; Harvey, Forecasting, Structural Time Series Models and the Kalman Filter, 3.4.
PredictionErrorFit FitPredictionError(const PreparedDataset& dataset, double propeller_separation_m,
                                      const FossenPrior& prior,
                                      const PredictionErrorOptions& options,
                                      const std::function<void(double share)>& progress = {});

}  // namespace telltale
