#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include "telltale/core/base/random.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale::testing {

/// Commands held for 2 to 6 steps at random levels in the regions asked for: one per time step.
inline std::vector<PropellerCommand> RandomCommands(std::size_t steps,
                                                    const std::vector<PropellerRegion>& regions,
                                                    std::uint64_t seed) {
  RandomEngine engine(seed);
  boost::random::uniform_int_distribution<std::size_t> pick(0, regions.size() - 1);
  boost::random::uniform_int_distribution<int> hold(2, 6);
  boost::random::uniform_real_distribution<double> level(0.1, 1.0);
  std::vector<PropellerCommand> commands;
  while (commands.size() < steps) {
    const PropellerRegion region = regions[pick(engine)];
    const bool port_forward = region == PropellerRegion::kFF || region == PropellerRegion::kFR;
    const bool starboard_forward = region == PropellerRegion::kFF || region == PropellerRegion::kRF;
    const double port = level(engine);
    const double starboard = level(engine);
    const PropellerCommand command{port_forward ? port : -port,
                                   starboard_forward ? starboard : -starboard};
    commands.insert(commands.end(), static_cast<std::size_t>(hold(engine)), command);
  }
  commands.resize(steps);
  return commands;
}

/// Rows made by the discrete model itself, nu(k+1) = nu(k) + h nu_dot(k): no sensor, no smoothing.
/// One segment, cut into slices of `slice_rows`.
inline PreparedDataset DriveDiscrete(const VesselModel& model,
                                     const std::vector<PropellerCommand>& commands,
                                     std::size_t slice_rows) {
  PreparedDataset dataset;
  const double h = model.sampling_period_s;
  dataset.sampling_period_s = h;
  PreparedRow row;
  for (std::size_t k = 0; k < commands.size(); ++k) {
    row.time_s = static_cast<double>(k) * h;
    row.delta = commands[k];
    row.region = RegionOf(row.delta);
    dataset.rows.push_back(row);
    const NuDot nu_dot = model.Acceleration(row.nu, row.delta);
    row.nu = {row.nu.u + h * nu_dot.u, row.nu.v + h * nu_dot.v, row.nu.r + h * nu_dot.r};
  }
  dataset.segments = {{0, commands.size()}};
  for (std::size_t begin = 0; begin < commands.size(); begin += slice_rows) {
    dataset.slices.push_back({begin, std::min(begin + slice_rows, commands.size())});
  }
  return dataset;
}

}  // namespace telltale::testing
