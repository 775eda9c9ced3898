#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/data/window.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/service/ingest/vehicle_window.hpp"

namespace telltale {

/// Why a sample reaches no window.
enum class UnattributedReason { kMalformedId, kUnknownVehicle, kUnreadable };

std::string_view Name(UnattributedReason reason);

/// The vehicles that this daemon serves, fixed for its life, and the counts of samples that name
/// none of them. The counts are safe to use from several threads.
class Fleet {
 public:
  using Windows = std::map<std::string, std::unique_ptr<VehicleWindow>, std::less<>>;

  Fleet(const std::vector<Vehicle>& vehicles, const WindowLimits& limits);

  /// The vehicle's window, or null when it is not served here.
  VehicleWindow* Find(std::string_view vehicle_id) const;
  const Windows& windows() const { return windows_; }

  /// The vehicles served, for people: "a, b, c".
  std::string Served() const;

  void CountUnattributed(std::string_view channel, UnattributedReason reason);
  /// Counts a sample that the bus cannot deserialise, where the topic carries telemetry.
  void CountUnreadable(std::string_view topic);
  std::vector<RejectEntry> Unattributed() const;

 private:
  Windows windows_;
  mutable std::mutex unattributed_mutex_;
  std::vector<RejectEntry> unattributed_;
};

}  // namespace telltale
