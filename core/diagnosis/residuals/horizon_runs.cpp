#include "telltale/core/diagnosis/residuals/horizon_runs.hpp"

#include <optional>
#include <string>
#include <utility>

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

}  // namespace

Result<RunsByHorizon> BuildFreeRuns(const PreparedDataset& recording,
                                    const std::vector<PreparedDataset>& references,
                                    const VesselModel& model) {
  RunsByHorizon by_horizon;
  for (const double horizon_s : kDiagnosis.horizons.horizons_s) {
    HorizonRuns runs{FreeRuns(recording, model, horizon_s), {}};
    for (const PreparedDataset& reference : references) {
      FreeRuns of_reference(reference, model, horizon_s);
      if (of_reference.Windows() > 0) runs.references.push_back(std::move(of_reference));
    }
    const bool is_main = horizon_s == kDiagnosis.horizons.main_s;
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
