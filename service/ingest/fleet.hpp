#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/data/window.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/service/ingest/vehicle_window.hpp"

namespace telltale {

/// Why a sample reaches no window.
enum class UnattributedReason { kMalformedId, kUnknownVehicle, kUnreadable, kForeignWriter };

std::string_view Name(UnattributedReason reason);

/// As reports name the announcements of vehicles, which they count beside the channels of
/// telemetry.
inline constexpr std::string_view kAnnouncements = "vehicle";

/// A vehicle is no longer served here.
struct NotServedError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The vehicles that this daemon serves, and the counts of samples that name none of them. Safe to
/// use from several threads. A window stays valid for the life of the fleet, also once its vehicle
/// is no longer served or has been changed.
class Fleet {
 public:
  using Windows = std::map<std::string, VehicleWindow*, std::less<>>;

  /// What a reload has changed, by vehicle id.
  struct Changes {
    std::vector<std::string> added;
    std::vector<std::string> changed;  ///< other parameters; its samples stay
    std::vector<std::string> removed;
  };

  /// The windows share `total_bytes` of memory evenly; none has more than its own limit, and none
  /// less than WindowLimits::kLeastMemory.
  Fleet(const std::vector<Vehicle>& vehicles, const WindowLimits& limits,
        std::size_t total_bytes = std::numeric_limits<std::size_t>::max());

  /// The vehicle's window, or null when it is not served here.
  VehicleWindow* Find(std::string_view vehicle_id) const;

  /// The same, throws NotServedError where it is not.
  VehicleWindow& WindowOf(const std::string& vehicle_id) const;

  /// Whether another daemon that shares the fleet serves the vehicle.
  bool IsServedElsewhere(std::string_view vehicle_id) const;
  Windows windows() const;

  /// Serves these vehicles from now on. Others that share the fleet serve the vehicles `elsewhere`.
  Changes Reload(const std::vector<Vehicle>& vehicles,
                 std::set<std::string, std::less<>> elsewhere = {});

  /// Another number once vehicles have been served anew: what Find() said before may be past.
  std::uint64_t Generation() const { return generation_; }

  /// What a client is told of a vehicle that is not served here: which ones are.
  std::string NotServed(const std::string& vehicle_id) const;

  /// `channel`: as reports name it, a channel of telemetry or kAnnouncements.
  void CountUnattributed(std::string_view channel, std::string_view reason,
                         std::uint64_t count = 1);
  /// Counts a sample that the bus cannot deserialise, where the topic is one of the vehicles'.
  void CountUnreadable(std::string_view topic);
  std::vector<RejectEntry> Unattributed() const;

 private:
  void Open(const Vehicle& vehicle);
  void ShareMemory();

  const WindowLimits limits_;
  const std::size_t total_bytes_;
  mutable std::shared_mutex windows_mutex_;  // of what follows
  Windows windows_;
  std::set<std::string, std::less<>> elsewhere_;
  std::vector<std::unique_ptr<VehicleWindow>> opened_;  ///< those of windows_, and former ones
  std::atomic<std::uint64_t> generation_ = 0;
  mutable std::mutex unattributed_mutex_;
  std::vector<RejectEntry> unattributed_;
};

}  // namespace telltale
