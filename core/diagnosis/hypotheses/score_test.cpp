#include "telltale/core/diagnosis/hypotheses/score_test.hpp"

#include <algorithm>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

// The square that is left decides the weight of the prior, and the sizes decide what is left: in
// turn.
constexpr int kRounds = 3;

/// The minimum of the posterior's cost, (88), that is linearised at no effect.
struct LinearEstimate {
  std::vector<Eigen::Index> columns;  ///< of the effect's parameters in the sensitivity
  Eigen::VectorXd sizes;              ///< in typical sizes, within the range
  double remaining_share = 1.0;       ///< of the square
};

/// Sizes within the ranges of the effect's parameters.
Eigen::VectorXd Clamped(Eigen::VectorXd sizes, const Effect& effect,
                        const std::vector<EffectParameterRef>& parameter_refs,
                        const std::vector<Eigen::Index>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const EffectParameterRef& ref = parameter_refs[static_cast<std::size_t>(columns[k])];
    const EffectParameter& parameter = effect.Parameters()[ref.parameter];
    double& size = sizes[static_cast<Eigen::Index>(k)];
    size =
        std::clamp(size, parameter.lower / parameter.typical, parameter.upper / parameter.typical);
  }
  return sizes;
}

LinearEstimate LinearEstimateOf(const Effect& effect, const ResidualMetric& metric,
                                const Eigen::MatrixXd& errors, const Sensitivity& recording,
                                const std::vector<EffectParameterRef>& parameter_refs) {
  constexpr double kPriorVariance =
      kDiagnosis.effect_fit.prior_width * kDiagnosis.effect_fit.prior_width;
  LinearEstimate estimate;
  estimate.columns = ColumnsOf(effect, parameter_refs);
  const Eigen::MatrixXd whitened =
      metric.WhitenColumns(recording.by_effect_parameter(Eigen::all, estimate.columns));
  const Eigen::MatrixXd marginalised = metric.Marginalise(whitened);
  const Eigen::VectorXd left = metric.Whiten(errors);
  const double none = metric.SquaredMahalanobis(left);
  const Eigen::VectorXd gradient = marginalised.transpose() * left;
  const Eigen::MatrixXd curvature = whitened.transpose() * marginalised;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd information = curvature;
    information.diagonal().array() +=
        estimate.remaining_share * none / metric.EffectiveObservations() / kPriorVariance;
    estimate.sizes =
        Clamped(-information.ldlt().solve(gradient), effect, parameter_refs, estimate.columns);
    const double decrease =
        -2.0 * gradient.dot(estimate.sizes) - estimate.sizes.dot(curvature * estimate.sizes);
    estimate.remaining_share =
        std::clamp(1.0 - decrease / none, kDiagnosis.effect_fit.minimum_remaining_share, 1.0);
  }
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
  std::vector<double> sizes = {parameter.typical, -parameter.typical};
  if (HidesBelowThreshold(effect, metric, recording, parameter_refs)) {
    sizes.push_back(kDiagnosis.effect_fit.beyond_threshold * parameter.typical);
  }
  for (const double size : sizes) {
    if (size < parameter.lower || size > parameter.upper) continue;
    Eigen::VectorXd start = prior_mean;
    start[static_cast<Eigen::Index>(ref.parameter)] = size;
    starts.push_back(start);
  }
  return starts;
}

bool HidesBelowThreshold(const Effect& effect, const ResidualMetric& metric,
                         const Sensitivity& recording,
                         const std::vector<EffectParameterRef>& parameter_refs) {
  const auto parameters = effect.Parameters();
  if (parameters.size() != 1 || parameters.front().lower < 0.0) return false;
  const Eigen::MatrixXd whitened = metric.WhitenColumns(
      recording.by_effect_parameter(Eigen::all, ColumnsOf(effect, parameter_refs)));
  return metric.Sigmas(whitened.col(0)) < kDiagnosis.testability.detectable_sigmas;
}

double ScoreTest(const Effect& effect, const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                 const Sensitivity& recording,
                 const std::vector<EffectParameterRef>& parameter_refs) {
  return metric.Deviance(
      LinearEstimateOf(effect, metric, errors, recording, parameter_refs).remaining_share, 1.0);
}

}  // namespace telltale
