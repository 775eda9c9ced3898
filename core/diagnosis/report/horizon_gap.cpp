#include "telltale/core/diagnosis/report/horizon_gap.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

GapSize GapSizeOf(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                  const NoiseFloor& floor, int channel) {
  GapSize size;
  size.before = std::sqrt(before.mean());
  size.after = std::sqrt(std::max(after.mean(), 0.0));
  size.noise_floor = std::sqrt(floor.Squared(channel));
  size.floor_limit = std::sqrt(floor.SquaredLimit(channel));
  return size;
}

}  // namespace

std::vector<HorizonErrors> HorizonErrorsOf(const RunsByHorizon& runs, const AugmentedModel& boat) {
  std::vector<HorizonErrors> horizons;
  for (const HorizonRuns& of_horizon : runs.horizons) {
    horizons.push_back({of_horizon.recording, NoiseFloorOf(of_horizon.references, boat),
                        of_horizon.recording.Errors(boat)});
  }
  return horizons;
}

Gap GapAt(const HorizonErrors& horizon, const std::optional<CrossValidatedErrors>& after,
          std::uint64_t seed) {
  Gap gap;
  gap.horizon_s = horizon.runs.HorizonS();
  gap.windows = horizon.runs.Windows();
  for (int channel = 0; channel <= kAllChannels; ++channel) {
    const Eigen::VectorXd before = horizon.SquaredGapsOf(channel);
    const Eigen::VectorXd then =
        after ? CrossValidatedSquaredGaps(*after, horizon.runs, horizon.floor, channel) : before;
    const GapSize size = GapSizeOf(before, then, horizon.floor, channel);
    std::optional<ExcessExplained> excess_explained;
    if (after) {
      excess_explained =
          ExcessExplainedBy(before, then, BlocksOf(horizon.runs), horizon.floor, channel, seed);
    }
    if (channel == kAllChannels) {
      gap.all = size;
      gap.excess_explained = excess_explained;
    } else {
      gap.channels[static_cast<std::size_t>(channel)] = size;
      gap.channel_excess_explained[static_cast<std::size_t>(channel)] = excess_explained;
    }
  }
  return gap;
}

std::optional<ExcessExplained> ExcessExplainedAt(const HorizonErrors& horizon,
                                                 const CrossValidatedErrors& after, int channel,
                                                 std::uint64_t seed) {
  return ExcessExplainedBy(horizon.SquaredGapsOf(channel),
                           CrossValidatedSquaredGaps(after, horizon.runs, horizon.floor, channel),
                           BlocksOf(horizon.runs), horizon.floor, channel, seed);
}

}  // namespace telltale
