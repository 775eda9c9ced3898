#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// The residual of one row and the conditions under which the boat met it.
struct AccelerationResidual {
  std::array<double, 3> error{};      ///< measured less predicted, m/s^2, m/s^2, rad/s^2
  std::array<double, 3> predicted{};  ///< the model's acceleration, likewise
  double time_s = 0.0;                ///< since the recording began
  Eta eta;
  Nu nu;
  PropellerCommand delta;
  std::size_t cluster = 0;  ///< residuals of one cluster may be correlated
  PropellerRegion region = PropellerRegion::kFF;
  std::size_t speed = 0;    ///< index of the speed bin
  std::size_t octant = 0;   ///< index of the heading's compass point
  std::size_t third = 0;    ///< of the recording
  bool after_step = false;  ///< commands have just changed
};

/// Residuals of a model over every pair of consecutive rows, each predicted from the measured state
/// of the first. Units: those of AccelerationResidual. docs/concepts/diagnosis.md (93).
std::vector<AccelerationResidual> AccelerationResidualsOf(const PreparedDataset& dataset,
                                                          const AugmentedModel& augmented);

/// Blocks of so many residuals without a gap, one after the other.
std::vector<std::span<const AccelerationResidual>> WholeBlocks(
    std::span<const AccelerationResidual> residuals, std::size_t rows, double sampling_period_s);

}  // namespace telltale
