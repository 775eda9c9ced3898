#include "telltale/service/storage/held_slices.hpp"

#include <utility>

namespace telltale {

SliceSet SetOf(const Slices& slices) {
  SliceSet set = 0;
  for (const auto& [slice, fence] : slices) set |= SetOf(slice);
  return set;
}

void HeldSlices::Set(Slices slices) {
  const std::lock_guard lock(mutex_);
  slices_ = std::move(slices);
}

Slices HeldSlices::Get() const {
  const std::lock_guard lock(mutex_);
  return slices_;
}

std::optional<Fence> HeldSlices::FenceOf(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto found = slices_.find(SliceOf(vehicle_id));
  return found == slices_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace telltale
