#include "telltale/service/ingest/fleet.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "telltale/client/bus/topics.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {

std::string_view Name(UnattributedReason reason) {
  switch (reason) {
    case UnattributedReason::kMalformedId: return "MALFORMED_VEHICLE_ID";
    case UnattributedReason::kUnknownVehicle: return "UNKNOWN_VEHICLE";
    case UnattributedReason::kUnreadable: return "UNREADABLE";
    case UnattributedReason::kForeignWriter: return "FOREIGN_WRITER";
  }
  return "";
}

Fleet::Fleet(const std::vector<Vehicle>& vehicles, const WindowLimits& limits,
             std::size_t total_bytes)
    : limits_(limits), total_bytes_(total_bytes) {
  for (const Vehicle& vehicle : vehicles) Open(vehicle);
  ShareMemory();
}

void Fleet::Open(const Vehicle& vehicle) {
  opened_.push_back(std::make_unique<VehicleWindow>(vehicle, limits_));
  windows_.insert_or_assign(vehicle.vehicle_id, opened_.back().get());
}

/// A window that is no longer served stays valid for who still reads it, and holds next to nothing.
void Fleet::ShareMemory() {
  const std::size_t share = total_bytes_ / std::max<std::size_t>(windows_.size(), 1);
  const std::size_t of_each =
      std::max(std::min(share, limits_.memory_bytes), WindowLimits::kLeastMemory);
  std::set<const VehicleWindow*> served;
  for (const auto& [vehicle_id, window] : windows_) {
    window->LimitMemory(of_each);
    served.insert(window);
  }
  for (const auto& window : opened_) {
    if (!served.contains(window.get())) window->LimitMemory(WindowLimits::kLeastMemory);
  }
}

VehicleWindow* Fleet::Find(std::string_view vehicle_id) const {
  const std::shared_lock lock(windows_mutex_);
  const auto found = windows_.find(vehicle_id);
  return found == windows_.end() ? nullptr : found->second;
}

Fleet::Windows Fleet::windows() const {
  const std::shared_lock lock(windows_mutex_);
  return windows_;
}

VehicleWindow& Fleet::WindowOf(const std::string& vehicle_id) const {
  VehicleWindow* const window = Find(vehicle_id);
  if (window == nullptr) throw NotServedError(NotServed(vehicle_id));
  return *window;
}

bool Fleet::IsServedElsewhere(std::string_view vehicle_id) const {
  const std::shared_lock lock(windows_mutex_);
  return elsewhere_.contains(vehicle_id);
}

Fleet::Changes Fleet::Reload(const std::vector<Vehicle>& vehicles,
                             std::set<std::string, std::less<>> elsewhere) {
  Changes changes;
  const std::unique_lock lock(windows_mutex_);
  elsewhere_ = std::move(elsewhere);
  std::set<std::string_view> named;
  for (const Vehicle& vehicle : vehicles) {
    named.insert(vehicle.vehicle_id);
    const auto present = windows_.find(vehicle.vehicle_id);
    if (present == windows_.end()) {
      Open(vehicle);
      changes.added.push_back(vehicle.vehicle_id);
    } else if (PrintVehicle(present->second->vehicle()) != PrintVehicle(vehicle)) {
      VehicleWindow& former = *present->second;
      Open(vehicle);
      windows_.find(vehicle.vehicle_id)->second->TakeOver(former);
      changes.changed.push_back(vehicle.vehicle_id);
    }
  }
  for (const auto& [vehicle_id, window] : windows_) {
    if (!named.contains(vehicle_id)) changes.removed.push_back(vehicle_id);
  }
  for (const std::string& vehicle_id : changes.removed) windows_.erase(vehicle_id);
  ShareMemory();
  ++generation_;
  return changes;
}

std::string Fleet::NotServed(const std::string& vehicle_id) const {
  std::string names;
  for (const auto& [served, window] : windows()) {
    if (!names.empty()) names += ", ";
    names += served;
  }
  return "vehicle '" + vehicle_id +
         "' is not served here; served: " + (names.empty() ? "none" : names);
}

void Fleet::CountUnattributed(std::string_view channel, std::string_view reason,
                              std::uint64_t count) {
  const std::lock_guard lock(unattributed_mutex_);
  const auto found = std::ranges::find_if(unattributed_, [&](const RejectEntry& entry) {
    return entry.channel == channel && entry.reason == reason;
  });
  if (found == unattributed_.end()) {
    unattributed_.push_back({std::string(channel), std::string(reason), count});
  } else {
    found->count += count;
  }
}

void Fleet::CountUnreadable(std::string_view topic) {
  constexpr std::string_view kTelemetry = "telltale/telemetry/";
  const std::string_view unreadable = Name(UnattributedReason::kUnreadable);
  if (topic == kContract<telltale_wire_VehicleAnnouncement>.topic) {
    return CountUnattributed(kAnnouncements, unreadable);
  }
  if (topic.starts_with(kTelemetry)) {
    CountUnattributed(topic.substr(kTelemetry.size()), unreadable);
  }
}

std::vector<RejectEntry> Fleet::Unattributed() const {
  const std::lock_guard lock(unattributed_mutex_);
  return unattributed_;
}

}  // namespace telltale
