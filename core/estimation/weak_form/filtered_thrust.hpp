#pragma once

#include <optional>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"
#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// The propeller regressors of every row of the dataset, filtered as the velocities are.
struct FilteredThrust {
  std::vector<ThrustRegressors> interval;  ///< mean over [t_k, t_k + h)
  std::vector<ThrustRegressors> filtered;  ///< smoothed over intervals as nu_k is over velocities
};

/// Follows the held commands of each segment through a first-order lag. An unset or zero time
/// constant means thrust without lag. Each segment starts with its thrusters settled on the oldest
/// command known.
FilteredThrust FilterThrust(const PreparedDataset& dataset, const WeakProblem& problem,
                            std::optional<double> time_constant_s);

}  // namespace telltale
