#include "telltale/service/ingest/fleet.hpp"

#include <algorithm>

namespace telltale {

std::string_view Name(UnattributedReason reason) {
  switch (reason) {
    case UnattributedReason::kMalformedId: return "MALFORMED_VEHICLE_ID";
    case UnattributedReason::kUnknownVehicle: return "UNKNOWN_VEHICLE";
    case UnattributedReason::kUnreadable: return "UNREADABLE";
  }
  return "";
}

Fleet::Fleet(const std::vector<Vehicle>& vehicles, const WindowLimits& limits) {
  for (const Vehicle& vehicle : vehicles) {
    windows_.emplace(vehicle.vehicle_id, std::make_unique<VehicleWindow>(vehicle, limits));
  }
}

VehicleWindow* Fleet::Find(std::string_view vehicle_id) const {
  const auto found = windows_.find(vehicle_id);
  return found == windows_.end() ? nullptr : found->second.get();
}

std::string Fleet::Served() const {
  std::string names;
  for (const auto& [vehicle_id, window] : windows_) {
    if (!names.empty()) names += ", ";
    names += vehicle_id;
  }
  return names.empty() ? "none" : names;
}

void Fleet::CountUnattributed(std::string_view channel, UnattributedReason reason) {
  const std::lock_guard lock(unattributed_mutex_);
  const auto found = std::ranges::find_if(unattributed_, [&](const RejectEntry& entry) {
    return entry.channel == channel && entry.reason == Name(reason);
  });
  if (found == unattributed_.end()) {
    unattributed_.push_back({std::string(channel), std::string(Name(reason)), 1});
  } else {
    ++found->count;
  }
}

void Fleet::CountUnreadable(std::string_view topic) {
  constexpr std::string_view kTelemetry = "telltale/telemetry/";
  if (!topic.starts_with(kTelemetry)) return;
  CountUnattributed(topic.substr(kTelemetry.size()), UnattributedReason::kUnreadable);
}

std::vector<RejectEntry> Fleet::Unattributed() const {
  const std::lock_guard lock(unattributed_mutex_);
  return unattributed_;
}

}  // namespace telltale
