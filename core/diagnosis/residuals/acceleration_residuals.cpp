#include "telltale/core/diagnosis/residuals/acceleration_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/operating_conditions.hpp"
#include "telltale/core/effects/augmented_boat.hpp"
#include "telltale/core/vessel/compass.hpp"

namespace telltale {
namespace {

bool JustStepped(const HeldCommands& commands, double time_s) {
  const PropellerCommand now = commands.At(time_s);
  const PropellerCommand then = commands.At(time_s - kDiagnosis.localisation.after_step_s);
  const double step = kDiagnosis.localisation.command_step;
  return std::abs(now.port - then.port) > step || std::abs(now.starboard - then.starboard) > step;
}

/// Whether no row is missing from the first one to the last.
bool IsWhole(std::span<const AccelerationResidual> residuals, double sampling_period_s) {
  const double expected_s = static_cast<double>(residuals.size() - 1) * sampling_period_s;
  return residuals.back().time_s - residuals.front().time_s < expected_s + 0.5 * sampling_period_s;
}

}  // namespace

std::vector<AccelerationResidual> AccelerationResidualsOf(const PreparedDataset& dataset,
                                                          const AugmentedModel& augmented) {
  const double h = dataset.sampling_period_s;
  const RecordingFrame frame = RecordingFrameOf(dataset);
  const AugmentedBoat boat(augmented, frame, dataset.hull);
  const std::size_t steps = StepsPerRow(augmented.model, h);
  const double step_s = h / static_cast<double>(steps);
  std::vector<AccelerationResidual> residuals;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& segment = dataset.segments[s];
    if (segment.size() < 2) continue;
    const double from_s = dataset.rows[segment.begin].time_s;
    const auto drives =
        boat.DrivesAlong(dataset.commands[s], from_s, step_s, segment.size() * steps);
    for (std::size_t k = segment.begin; k + 1 < segment.end; ++k) {
      const PreparedRow& row = dataset.rows[k];
      const auto ahead = std::span(drives).subspan((k - segment.begin) * steps, steps);
      const Nu predicted = boat.Simulate({row.eta, row.nu}, ahead, row.time_s, step_s).back().nu;
      const Nu& next = dataset.rows[k + 1].nu;
      AccelerationResidual residual;
      residual.error = {(next.u - predicted.u) / h, (next.v - predicted.v) / h,
                        (next.r - predicted.r) / h};
      residual.predicted = {(predicted.u - row.nu.u) / h, (predicted.v - row.nu.v) / h,
                            (predicted.r - row.nu.r) / h};
      const double since_s = row.time_s - frame.start_s;
      residual.time_s = since_s;
      residual.eta = row.eta;
      residual.nu = row.nu;
      residual.delta = row.delta;
      residual.cluster = static_cast<std::size_t>(since_s / kDiagnosis.localisation.cluster_s);
      residual.region = row.region;
      residual.speed = SpeedBin(std::hypot(row.nu.u, row.nu.v));
      residual.octant = NearestCompassPoint(row.eta.psi_rad);
      residual.third =
          std::min<std::size_t>(static_cast<std::size_t>(3.0 * since_s / frame.span_s), 2);
      residual.after_step = JustStepped(dataset.commands[s], row.time_s);
      residuals.push_back(residual);
    }
  }
  return residuals;
}

std::vector<std::span<const AccelerationResidual>> WholeBlocks(
    std::span<const AccelerationResidual> residuals, std::size_t rows, double sampling_period_s) {
  std::vector<std::span<const AccelerationResidual>> blocks;
  std::size_t first = 0;
  while (first + rows <= residuals.size()) {
    const auto block = residuals.subspan(first, rows);
    const bool is_whole = IsWhole(block, sampling_period_s);
    if (is_whole) blocks.push_back(block);
    first += is_whole ? rows : 1;
  }
  return blocks;
}

}  // namespace telltale
