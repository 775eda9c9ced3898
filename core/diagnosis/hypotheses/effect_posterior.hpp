#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"

namespace telltale {

/// Free-run errors of the baseline boat with effects. Shapes: rows x windows.
using ErrorModel = std::function<Eigen::MatrixXd(const std::vector<ModelledEffect>&)>;

/// A stack of scaled parameters with what it leaves of the errors.
struct PosteriorPoint {
  Eigen::VectorXd scaled;
  Eigen::MatrixXd errors;    ///< rows x windows
  Eigen::VectorXd whitened;  ///< the errors by ResidualMetric::Whiten
  double square = 0.0;       ///< squared Mahalanobis distance of the whitened errors
  double cost = 0.0;         ///< -2 ln of the posterior, up to a constant
};

/// The posterior of effect parameters, up to a constant: -2 ln p = n ln(square) + a' P^-1 a, n the
/// effective observations, docs/concepts/diagnosis.md (88). Errors within a window are correlated
/// and their scale is unknown; a square that counted them as independent would leave the prior
/// without weight. The arguments have to outlive it.
class EffectPosterior {
 public:
  EffectPosterior(const ErrorModel& error_model, const ResidualMetric& metric,
                  const EffectParameters& parameters)
      : error_model_(error_model), metric_(metric), parameters_(parameters) {}

  PosteriorPoint At(const Eigen::VectorXd& scaled) const;

  /// Derivatives of the whitened errors by the scaled parameters, by finite differences.
  Eigen::MatrixXd Jacobian(const PosteriorPoint& point) const;

  /// Half the curvature of the cost, the residuals' own curvature neglected. Shapes: `marginalised`
  /// is the Jacobian by ResidualMetric::Marginalise.
  Eigen::MatrixXd Information(const PosteriorPoint& point, const Eigen::MatrixXd& jacobian,
                              const Eigen::MatrixXd& marginalised) const;

  /// Half the gradient of the cost.
  Eigen::VectorXd Gradient(const PosteriorPoint& point, const Eigen::MatrixXd& marginalised) const;

  const ResidualMetric& Metric() const { return metric_; }
  const EffectParameters& Parameters() const { return parameters_; }

 private:
  /// The square, above zero.
  double ScaleOf(const PosteriorPoint& point) const;

  /// By how much n ln(square) grows with the square.
  double Precision(const PosteriorPoint& point) const {
    return metric_.EffectiveObservations() / ScaleOf(point);
  }

  const ErrorModel& error_model_;
  const ResidualMetric& metric_;
  const EffectParameters& parameters_;
};

}  // namespace telltale
