#include "telltale/core/uncertainty/parametric_bootstrap.hpp"

#include <algorithm>
#include <vector>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"

namespace telltale {

BootstrapReplicates SimulateReplicates(
    const PreparedDataset& dataset, const VesselModel& model, const Disturbance& disturbance,
    const Refit& original,
    const std::function<std::optional<Refit>(const PreparedDataset&)>& reestimate,
    const BootstrapOptions& options) {
  std::vector<std::optional<Refit>> all(options.replicates);
  ForEachIndex(all.size(), options.threads, [&](std::size_t i) {
    SyntheticDatasetOptions simulation_options;
    simulation_options.disturbance = disturbance;
    simulation_options.readings = Readings::kLeftOut;
    simulation_options.seed = RandomEngine::Stream(options.seed, i)();
    const auto replicate = SimulateDataset(dataset, model, simulation_options);
    if (!replicate) return;
    all[i] = reestimate(*replicate);
    if (all[i] && !(all[i]->theta.allFinite() && all[i]->standard_error.allFinite())) {
      all[i].reset();
    }
  });
  std::erase(all, std::nullopt);

  BootstrapReplicates replicates;
  replicates.estimate = original.theta;
  replicates.standard_error = original.standard_error;
  replicates.acceleration = Eigen::VectorXd::Zero(original.theta.size());
  replicates.draws = dataset.slices.size();
  replicates.failures = options.replicates - all.size();
  const auto solved = static_cast<Eigen::Index>(all.size());
  replicates.theta.resize(original.theta.size(), solved);
  replicates.standard_errors.resize(original.theta.size(), solved);
  for (Eigen::Index i = 0; i < solved; ++i) {
    replicates.theta.col(i) = all[static_cast<std::size_t>(i)]->theta;
    replicates.standard_errors.col(i) = all[static_cast<std::size_t>(i)]->standard_error;
  }
  return replicates;
}

}  // namespace telltale
