#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// Free runs of one horizon.
struct HorizonRuns {
  FreeRuns recording;
  std::vector<FreeRuns> references;  ///< those that have windows of this horizon
};

/// Free runs of a recording and its references by horizon, ascending.
struct RunsByHorizon {
  std::vector<HorizonRuns> horizons;
  std::size_t main = 0;  ///< the place of kDiagnosis.horizons.main_s

  const HorizonRuns& Main() const { return horizons[main]; }
};

/// Free runs at each of kDiagnosis.horizons that leaves windows in the recording and in at least
/// one reference. The datasets have to outlive them. Refuses when: at the main horizon the
/// recording has fewer windows than kDiagnosis.recording.minimum_windows, or no reference has any.
Result<RunsByHorizon> BuildFreeRuns(const PreparedDataset& recording,
                                    const std::vector<PreparedDataset>& references,
                                    const VesselModel& model, std::size_t threads);

}  // namespace telltale
