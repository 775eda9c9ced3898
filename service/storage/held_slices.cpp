#include "telltale/service/storage/held_slices.hpp"

#include <utility>

#include "telltale/service/storage/checksum.hpp"

namespace telltale {

int SliceOf(std::string_view vehicle_id) {
  return static_cast<int>(ChecksumOf(vehicle_id) % kFleetSlices);
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
