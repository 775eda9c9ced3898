#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "telltale/core/estimation/prediction_error/prediction_error.hpp"

namespace telltale {

/// The covariance of a fit's estimates, in the order of FossenParameter. It is widened, so that a
/// normal interval is Student's, by one factor for all parameters: data know some directions in
/// which several parameters move together far better than each of them, and a factor for each would
/// turn those directions.
struct RobustCovariance {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd own_widening;        ///< of each standard error, by its own factor in place of it
  Eigen::VectorXd degrees_of_freedom;  ///< of each standard error

  /// For each parameter by itself.
  Eigen::MatrixXd ForSingles() const;
};

/// The blocks' own covariance counts by blocks / (blocks + parameters), the rest is the shape of
/// the information: the covariance is as precise as one of (blocks + parameters)^2 / blocks blocks.
std::size_t EquivalentBlocks(std::size_t blocks);

/// The variance of the blocks' scores over that which the information expects of them.
double DispersionOf(const PredictionErrorFit& fit);

/// P (B + Lambda) P of docs/concepts/physical-model.md (112), (113).
/// Where blocks are few the shape of the information helps: once with all scores scattered alike
/// beyond it, once with each parameter's score by its own scatter; the larger variance counts, of
/// all together its mean over the first one. A fit takes part of each block's score for itself,
/// most where a parameter's information stands in few blocks: scores are scaled by (I - H)^(-1/2),
/// H the block's leverage, and a parameter's degrees of freedom are those of the blocks that inform
/// it. Source: Bell and McCaffrey, "Bias reduction in standard errors for linear regression with
/// multi-stage samples", Survey Methodology 28 (2002).
RobustCovariance CovarianceOf(const PredictionErrorFit& fit, double level);

}  // namespace telltale
