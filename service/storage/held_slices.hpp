#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>

#include "telltale/idl/codec/fleet_slices.hpp"

namespace telltale {

/// The number of a lease. It grows with each lease of a slice, so that a write under an earlier
/// lease shows.
using Fence = std::int64_t;

/// Slices with the leases under which they are held.
using Slices = std::map<int, Fence>;

/// The slices alone.
SliceSet SetOf(const Slices& slices);

/// The slices that this daemon holds. Thread safe.
class HeldSlices {
 public:
  void Set(Slices slices);
  Slices Get() const;

  /// Of the lease that holds the slice of this vehicle; nothing where none does.
  std::optional<Fence> FenceOf(std::string_view vehicle_id) const;

 private:
  mutable std::mutex mutex_;
  Slices slices_;
};

}  // namespace telltale
