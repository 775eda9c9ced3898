#include "telltale/core/validation/augmented_free_runs.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "telltale/core/effects/sensor_chain.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {

AugmentedFreeRuns::AugmentedFreeRuns(const PreparedDataset& dataset, const AugmentedModel& model)
    : dataset_(dataset),
      boat_(model, RecordingFrameOf(dataset), dataset.hull),
      steps_(StepsPerRow(model.model, dataset.sampling_period_s)),
      step_s_(dataset.sampling_period_s / static_cast<double>(steps_)) {}

std::vector<Drive> AugmentedFreeRuns::DrivesAlong(std::size_t segment) const {
  const RowRange& rows = dataset_.segments[segment];
  return boat_.DrivesAlong(dataset_.commands[segment], dataset_.rows[rows.begin].time_s, step_s_,
                           rows.size() * steps_);
}

std::vector<PreparedRow> AugmentedFreeRuns::Run(const RowRange& segment, std::size_t first,
                                                std::size_t rows,
                                                const std::vector<Drive>& drives) const {
  const double from_s = dataset_.rows[first].time_s;
  const auto ahead = std::span(drives).subspan((first - segment.begin) * steps_, rows * steps_);
  const std::vector<Pose> track =
      boat_.Simulate(TrueStart(dataset_, segment, from_s, boat_), ahead, from_s, step_s_);
  std::vector<PreparedRow> predicted;
  for (std::size_t k = 0; k <= rows; ++k) {
    const Pose& now = track[k * steps_];
    const auto late =
        static_cast<std::size_t>(std::lround(std::max(boat_.LatencyS(), 0.0) / step_s_));
    const Pose& past = track[k * steps_ - std::min(late, k * steps_)];
    const Pose measured = MeasuredPose(now, past, dataset_.sensors.antenna, boat_);
    PreparedRow row;
    row.eta = measured.eta;
    row.nu = measured.nu;
    predicted.push_back(row);
  }
  return predicted;
}

}  // namespace telltale
