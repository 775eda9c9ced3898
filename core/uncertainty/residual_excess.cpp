#include "telltale/core/uncertainty/residual_excess.hpp"

#include <algorithm>

#include "telltale/core/estimation/disturbance.hpp"
#include "telltale/core/simulation/dataset_twin.hpp"

namespace telltale {
namespace {

double MeanSquare(const Eigen::VectorXd& residual) {
  return residual.squaredNorm() / static_cast<double>(residual.size());
}

}  // namespace

std::optional<double> ResidualExcess(const PreparedDataset& dataset,
                                     const RegressionOptions& regression, const WeakFit& fit,
                                     const WeakFormOptions& form, std::uint64_t seed) {
  const Eigen::VectorXd theta = fit.Damped();
  TwinOptions still_water;
  still_water.seed = seed;
  still_water.as_measured = {!fit.equations[0], !fit.equations[1], !fit.equations[2]};
  const auto twin = SailAgain(dataset, ModelOf(fit, theta, dataset.sampling_period_s), still_water);
  if (!twin) return std::nullopt;
  const auto by_sensors = ResidualsOf(fit, theta, *twin, BuildWeakForm(*twin, regression, form));
  double excess = 0.0;
  for (std::size_t j = 0; j < by_sensors.size(); ++j) {
    if (!fit.equations[j] || by_sensors[j].size() == 0) continue;
    excess = std::max(excess, MeanSquare(fit.equations[j]->residual) / MeanSquare(by_sensors[j]));
  }
  return excess;
}

}  // namespace telltale
