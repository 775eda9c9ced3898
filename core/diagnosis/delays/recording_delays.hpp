#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/identification/physical_model.hpp"

namespace telltale {

/// A delay that one recording alone shows, in s.
struct DelayEstimate {
  double delay_s = 0.0;
  double standard_error_s = 0.0;
};

/// In the order of kDelayedChannels.
using RecordingDelays = std::array<DelayEstimate, kDelayedChannels.size()>;

/// The delays of the physical form fitted to one recording about the boat's model,
/// PhysicalModelAbout(). None where that does not converge.
std::optional<RecordingDelays> RecordingDelaysOf(const PreparedDataset& recording,
                                                 const PhysicalModel& model);

/// The delays of a recording and of each reference, in their order.
struct ComparedDelays {
  std::optional<RecordingDelays> recording;
  std::vector<std::optional<RecordingDelays>> references;
};

/// `threads` never changes the result. `report_progress` gets the share done; it is called by one
/// thread at a time.
ComparedDelays ComparedDelaysOf(const PreparedDataset& recording,
                                const std::vector<PreparedDataset>& references,
                                const PhysicalModel& model, std::size_t threads,
                                const std::function<void(double)>& report_progress);

}  // namespace telltale
