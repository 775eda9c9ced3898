#include "telltale/core/identification/simulated_replicates.hpp"

#include <algorithm>
#include <vector>

#include "telltale/core/parallel.hpp"
#include "telltale/core/random.hpp"
#include "telltale/core/simulation/dataset_twin.hpp"

namespace telltale {

BootstrapReplicates SimulateReplicates(
    const PreparedDataset& dataset, const VesselModel& model, const Disturbance& disturbance,
    const Refit& original,
    const std::function<std::optional<Refit>(const PreparedDataset&)>& estimate_again,
    const BootstrapOptions& options) {
  std::vector<std::optional<Refit>> all(options.replicates);
  ForEachIndex(all.size(), options.threads, [&](std::size_t i) {
    TwinOptions twin;
    twin.disturbance = disturbance;
    twin.seed = RandomEngine::Stream(options.seed, i)();
    const auto repeat = SailAgain(dataset, model, twin);
    if (!repeat) return;
    all[i] = estimate_again(*repeat);
    if (all[i] && !(all[i]->theta.allFinite() && all[i]->standard_error.allFinite())) {
      all[i].reset();
    }
  });
  std::erase(all, std::nullopt);

  BootstrapReplicates replicates;
  replicates.estimate = original.theta;
  replicates.standard_error = original.standard_error;
  replicates.acceleration = Eigen::VectorXd::Zero(original.theta.size());
  replicates.draws = dataset.segments.size();
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
