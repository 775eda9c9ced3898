#include "telltale/core/diagnosis/residuals/horizon_runs.hpp"

#include <optional>
#include <string>
#include <utility>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

std::optional<Refusal> CheckMainHorizon(const HorizonRuns& runs) {
  if (runs.recording.Windows() < kDiagnosis.recording.minimum_windows) {
    return Refusal{"recording",
                   "only " + std::to_string(runs.recording.Windows()) + " windows of five seconds",
                   "record a minute or more without gaps"};
  }
  if (runs.references.empty()) {
    return Refusal{"reference", "no window of five seconds without gaps",
                   "name reference logs of a minute or more"};
  }
  return std::nullopt;
}

/// Of the recording and its references at every horizon.
std::vector<HorizonRuns> AllFreeRuns(const PreparedDataset& recording,
                                     const std::vector<PreparedDataset>& references,
                                     const VesselModel& model, std::size_t threads) {
  constexpr auto& kHorizons = kDiagnosis.horizons.horizons_s;
  std::vector<const PreparedDataset*> datasets = {&recording};
  for (const PreparedDataset& reference : references) datasets.push_back(&reference);
  std::vector<std::optional<FreeRuns>> built(kHorizons.size() * datasets.size());
  ForEachIndex(built.size(), threads, [&](std::size_t i) {
    built[i].emplace(*datasets[i % datasets.size()], model, kHorizons[i / datasets.size()]);
  });
  std::vector<HorizonRuns> all;
  for (std::size_t i = 0; i < built.size(); ++i) {
    if (i % datasets.size() == 0) {
      all.push_back({*std::move(built[i]), {}});
    } else if (built[i]->Windows() > 0) {
      all.back().references.push_back(*std::move(built[i]));
    }
  }
  return all;
}

}  // namespace

Result<RunsByHorizon> BuildFreeRuns(const PreparedDataset& recording,
                                    const std::vector<PreparedDataset>& references,
                                    const VesselModel& model, std::size_t threads) {
  RunsByHorizon by_horizon;
  for (HorizonRuns& runs : AllFreeRuns(recording, references, model, threads)) {
    const bool is_main = runs.recording.HorizonS() == kDiagnosis.horizons.main_s;
    if (is_main) {
      if (auto refusal = CheckMainHorizon(runs))
        return tl::unexpected<Refusal>(*std::move(refusal));
      by_horizon.main = by_horizon.horizons.size();
    }
    if (runs.recording.Windows() == 0 || runs.references.empty()) continue;
    by_horizon.horizons.push_back(std::move(runs));
  }
  return by_horizon;
}

}  // namespace telltale
