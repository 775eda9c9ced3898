#include "telltale/core/uncertainty/residual_variance_ratio.hpp"

#include <algorithm>

#include "telltale/core/estimation/weak_form/disturbance_estimate.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"

namespace telltale {
namespace {

double MeanSquare(const Eigen::VectorXd& residual) {
  return residual.squaredNorm() / static_cast<double>(residual.size());
}

}  // namespace

std::optional<double> ResidualVarianceRatio(const PreparedDataset& dataset,
                                            const RegressionOptions& regression, const WeakFit& fit,
                                            const WeakFormOptions& form, std::uint64_t seed) {
  const Eigen::VectorXd theta = fit.Regularised();
  SyntheticDatasetOptions undisturbed;
  undisturbed.seed = seed;
  undisturbed.readings = Readings::kLeftOut;
  undisturbed.as_measured = {!fit.equations[0], !fit.equations[1], !fit.equations[2]};
  const auto replicate =
      SimulateDataset(dataset, ModelOf(fit, theta, dataset.sampling_period_s), undisturbed);
  if (!replicate) return std::nullopt;
  const auto by_sensors =
      ResidualsOf(fit, theta, *replicate, BuildWeakForm(*replicate, regression, form));
  double variance_ratio = 0.0;
  for (std::size_t j = 0; j < by_sensors.size(); ++j) {
    if (!fit.equations[j] || by_sensors[j].size() == 0) continue;
    variance_ratio = std::max(variance_ratio,
                              MeanSquare(fit.equations[j]->residual) / MeanSquare(by_sensors[j]));
  }
  return variance_ratio;
}

}  // namespace telltale
