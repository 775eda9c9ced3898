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
  double cost = 0.0;         ///< square plus the negative log prior, times two
};

/// The posterior of effect parameters, up to a constant: -2 ln p = square + a' P^-1 a,
/// docs/concepts/diagnosis.md (87), (88). The arguments have to outlive it.
class EffectPosterior {
 public:
  EffectPosterior(const ErrorModel& error_model, const ResidualMetric& metric,
                  const EffectParameters& parameters)
      : error_model_(error_model), metric_(metric), parameters_(parameters) {}

  PosteriorPoint At(const Eigen::VectorXd& scaled) const;

  /// Derivatives of the whitened errors by the scaled parameters, by finite differences.
  Eigen::MatrixXd Jacobian(const PosteriorPoint& point) const;

  const ResidualMetric& Metric() const { return metric_; }
  const EffectParameters& Parameters() const { return parameters_; }

 private:
  const ErrorModel& error_model_;
  const ResidualMetric& metric_;
  const EffectParameters& parameters_;
};

}  // namespace telltale
