#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// How a model errs in a free run, beside what may have made it err.
struct RunError {
  std::array<double, 3> mean{};    ///< of surge, sway (m/s), yaw (rad/s): measured less predicted
  std::array<double, 3> square{};  ///< mean of the squares of the same
  PropellerCommand command;        ///< mean
  /// What wind and current do to a first approximation: a constant, the cosine and sine of the
  /// heading, and both times the yaw rate.
  Eigen::VectorXd weather;
  /// What the commands do: the squares of those of each side, ahead and astern, and u, v, r, u v,
  /// u r as the model follows the commands alone. Gusts move the measured velocities, not these.
  Eigen::VectorXd commanded;
};

/// The errors of the free runs of kDrift.window_s that begin at `from_s` or later, in order of
/// time. The commands are followed from the start of each segment. None of a run in which the model
/// diverges, kFreeRunDivergence, and none of a model that lacks an equation.
std::vector<RunError> RunErrorsOf(const PreparedDataset& dataset,
                                  const Identification& identification, double from_s);

}  // namespace telltale
