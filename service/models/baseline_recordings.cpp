#include "telltale/service/models/baseline_recordings.hpp"

#include <utility>

namespace telltale {

void BaselineRecordings::Keep(const std::string& vehicle_id, std::uint64_t revision,
                              Recording recording) {
  const std::lock_guard lock(mutex_);
  kept_.insert_or_assign(vehicle_id, Kept{revision, std::move(recording)});
}

std::optional<Recording> BaselineRecordings::Behind(std::string_view vehicle_id,
                                                    std::uint64_t revision) const {
  const std::lock_guard lock(mutex_);
  const auto found = kept_.find(vehicle_id);
  if (found == kept_.end() || found->second.revision != revision) return std::nullopt;
  return found->second.recording;
}

}  // namespace telltale
