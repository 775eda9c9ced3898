#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/prediction_error/fossen_prior.hpp"
#include "telltale/core/estimation/prediction_error/noise_model.hpp"
#include "telltale/core/estimation/prediction_error/normal_equations.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// A model that a search begins at.
struct PredictionErrorStart {
  FossenVector parameters;
  NoiseModel noise;  ///< of every recording
};

struct PredictionErrorOptions {
  std::size_t threads = 1;
  int max_iterations = 25;
  double block_s = 10.0;  ///< length of the blocks behind the robust covariance
  /// Near a solution few iterations are left. Without, the search begins at the prior.
  std::optional<PredictionErrorStart> start = {};
  /// Whether nothing but a solution will do whose instruments the commands alone drive. One whose
  /// boat follows the filter is less free of what disturbs the boat: waves move delays. Where there
  /// is none, the fit ends unconverged at once.
  bool free_instruments_only = false;
};

/// The fit of the physical form. Vectors and matrices in the order of FossenParameter.
struct PredictionErrorFit {
  FossenVector parameters;
  std::vector<NoiseModel> noise;  ///< by recording
  Eigen::VectorXd newton_mean;    ///< the minimum of the quadratic model without physical ranges
  Eigen::MatrixXd information;    ///< of the instruments and the prior
  Eigen::MatrixXd slope;          ///< of the estimating equations, prior included
  Eigen::MatrixXd data_information;
  std::vector<ScoreBlock> blocks;      ///< of the data, by time
  std::vector<ScoreBlock> recordings;  ///< the same by recordings
  std::size_t innovations = 0;
  int iterations = 0;
  /// Whether (110) is solved. Without, the parameters are those of the slopes alone, which
  /// disturbances of the boat bias.
  bool converged = false;
};

/// The parameters at which the innovations of an extended Kalman filter are orthogonal to
/// instruments, prior included; docs/concepts/physical-model.md (110)..(112). The current and the
/// misalignment of the compass are states of the filter, so that each recording has its own; so is
/// its noise, which maximises the likelihood.
/// A prediction-error method comes first: slopes at fixed gains. They follow what has disturbed the
/// boat before, and where the filter's noise is not the boat's, innovations do so too, which biases
/// it. Then the instruments, the slopes of a boat that the commands alone drive, take their place.
/// Where that boat tells nothing of the one that was recorded, it follows it slowly.
/// Source: Ljung, System Identification, 2nd ed., 7.2, 7.4 and 7.6; Harvey, Forecasting, Structural
/// Time Series Models and the Kalman Filter, 3.4.
PredictionErrorFit FitPredictionError(const PreparedDataset& dataset, double propeller_separation_m,
                                      const FossenPrior& prior,
                                      const PredictionErrorOptions& options,
                                      const std::function<void(double share)>& progress = {});

}  // namespace telltale
