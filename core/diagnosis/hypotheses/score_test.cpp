#include "telltale/core/diagnosis/hypotheses/score_test.hpp"

#include <algorithm>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

/// The minimum of the cost that is linearised at no effect.
struct LinearEstimate {
  std::vector<Eigen::Index> columns;  ///< of the effect's parameters in the sensitivity
  Eigen::VectorXd sizes;              ///< in typical sizes, within the range
  double decrease = 0.0;              ///< of the cost
};

std::vector<Eigen::Index> ColumnsOf(const Effect& effect,
                                    const std::vector<EffectParameterRef>& parameter_refs) {
  std::vector<Eigen::Index> columns;
  for (std::size_t j = 0; j < parameter_refs.size(); ++j) {
    if (parameter_refs[j].effect == &effect) columns.push_back(static_cast<Eigen::Index>(j));
  }
  return columns;
}

LinearEstimate LinearEstimateOf(const Effect& effect, const ResidualMetric& metric,
                                const Eigen::MatrixXd& errors, const Sensitivity& recording,
                                const std::vector<EffectParameterRef>& parameter_refs) {
  LinearEstimate estimate;
  estimate.columns = ColumnsOf(effect, parameter_refs);
  const Eigen::MatrixXd whitened =
      metric.WhitenColumns(recording.by_effect_parameter(Eigen::all, estimate.columns));
  const Eigen::MatrixXd marginalised = metric.Marginalise(whitened);
  const Eigen::VectorXd gradient = marginalised.transpose() * metric.Whiten(errors);
  Eigen::MatrixXd information = whitened.transpose() * marginalised;
  information.diagonal().array() +=
      1.0 / (kDiagnosis.effect_fit.prior_width * kDiagnosis.effect_fit.prior_width);
  estimate.sizes = -information.ldlt().solve(gradient);
  for (std::size_t k = 0; k < estimate.columns.size(); ++k) {
    const EffectParameterRef& ref = parameter_refs[static_cast<std::size_t>(estimate.columns[k])];
    const EffectParameter& parameter = effect.Parameters()[ref.parameter];
    double& size = estimate.sizes[static_cast<Eigen::Index>(k)];
    size =
        std::clamp(size, parameter.lower / parameter.typical, parameter.upper / parameter.typical);
  }
  estimate.decrease =
      -2.0 * gradient.dot(estimate.sizes) - estimate.sizes.dot(information * estimate.sizes);
  return estimate;
}

Eigen::VectorXd PriorMeanOf(const Effect& effect) {
  Eigen::VectorXd prior_mean(static_cast<Eigen::Index>(effect.Parameters().size()));
  for (Eigen::Index i = 0; i < prior_mean.size(); ++i) {
    prior_mean[i] = effect.Parameters()[static_cast<std::size_t>(i)].prior_mean;
  }
  return prior_mean;
}

}  // namespace

std::vector<Eigen::VectorXd> StartsOf(const Effect& effect, const ResidualMetric& metric,
                                      const Eigen::MatrixXd& errors, const Sensitivity& recording,
                                      const std::vector<EffectParameterRef>& parameter_refs) {
  const LinearEstimate estimate =
      LinearEstimateOf(effect, metric, errors, recording, parameter_refs);
  const Eigen::VectorXd prior_mean = PriorMeanOf(effect);
  std::vector<Eigen::VectorXd> starts = {prior_mean};
  for (std::size_t k = 0; k < estimate.columns.size(); ++k) {
    const EffectParameterRef& ref = parameter_refs[static_cast<std::size_t>(estimate.columns[k])];
    starts[0][static_cast<Eigen::Index>(ref.parameter)] =
        effect.Parameters()[ref.parameter].typical * estimate.sizes[static_cast<Eigen::Index>(k)];
  }
  if (estimate.columns.size() != 1) return starts;
  const EffectParameterRef& ref = parameter_refs[static_cast<std::size_t>(estimate.columns[0])];
  const EffectParameter& parameter = effect.Parameters()[ref.parameter];
  for (const double size : {parameter.typical, -parameter.typical}) {
    if (size < parameter.lower || size > parameter.upper) continue;
    Eigen::VectorXd start = prior_mean;
    start[static_cast<Eigen::Index>(ref.parameter)] = size;
    starts.push_back(start);
  }
  return starts;
}

double ScoreTest(const Effect& effect, const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                 const Sensitivity& recording,
                 const std::vector<EffectParameterRef>& parameter_refs) {
  const double none = metric.SquaredMahalanobis(metric.Whiten(errors));
  const double decrease =
      LinearEstimateOf(effect, metric, errors, recording, parameter_refs).decrease;
  return metric.Deviance(
      std::clamp(none - decrease, kDiagnosis.effect_fit.minimum_remaining_share * none, none),
      none);
}

}  // namespace telltale
