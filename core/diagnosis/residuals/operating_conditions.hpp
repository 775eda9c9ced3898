#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/residuals/acceleration_residuals.hpp"

namespace telltale {

/// A part of the operating range: its name and which residuals lie in it.
struct OperatingCondition {
  std::optional<PropellerRegion> region;
  std::string bin;  ///< "0.5 to 1.0 m/s", "heading NE"; empty for all
  std::function<bool(const AccelerationResidual&)> holds;
};

/// The whole range first, then propeller region, region by speed, speed, heading, third of the
/// recording, after a step or not.
std::vector<OperatingCondition> OperatingConditions();

/// The index of a speed's bin among those of LocalisationConstants.
std::size_t SpeedBin(double speed_m_s);

}  // namespace telltale
