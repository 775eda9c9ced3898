#include "telltale/service/registry/vehicle_registry.hpp"

#include <algorithm>
#include <utility>

#include <fnmatch.h>

#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

// Each change leaves a former window behind.
constexpr std::uint64_t kMostChanges = 5;
constexpr auto kPeriodOfChanges = std::chrono::minutes(10);

std::map<std::string, Vehicle> ById(std::vector<Vehicle> vehicles) {
  std::map<std::string, Vehicle> by_id;
  for (Vehicle& vehicle : vehicles) {
    const std::string id = vehicle.vehicle_id;
    by_id.emplace(id, std::move(vehicle));
  }
  return by_id;
}

}  // namespace

std::string_view Name(Admission admission) {
  switch (admission) {
    case Admission::kAdmitted: return "ADMITTED";
    case Admission::kChanged: return "CHANGED";
    case Admission::kKnown: return "KNOWN";
    case Admission::kConfigured: return "CONFIGURED";
    case Admission::kNotAdmitted: return "NOT_ADMITTED";
    case Admission::kBeyondLimit: return "BEYOND_LIMIT";
    case Admission::kTooManyChanges: return "TOO_MANY_CHANGES";
  }
  return "";
}

VehicleRegistry::VehicleRegistry(const Storage& storage, std::vector<Vehicle> configured,
                                 AnnouncedSettings announced)
    : storage_(storage),
      store_(storage),
      configured_(ById(std::move(configured))),
      rule_(std::move(announced)) {
  ReadStored();
}

void VehicleRegistry::Configure(std::vector<Vehicle> configured, AnnouncedSettings announced) {
  configured_ = ById(std::move(configured));
  rule_ = std::move(announced);
}

Admission VehicleRegistry::Announce(const Vehicle& vehicle, Clock::time_point now) {
  const std::string& id = vehicle.vehicle_id;
  if (IsConfigured(id)) return Admission::kConfigured;
  if (!Admits(id)) return Admission::kNotAdmitted;
  const auto known = announced_.find(id);
  const bool is_new = known == announced_.end();
  if (!is_new && PrintVehicle(known->second) == PrintVehicle(vehicle)) return Admission::kKnown;
  if (!changes_.contains(id) && changes_.size() >= rule_.most) return Admission::kBeyondLimit;
  RateLimit& changes = changes_.try_emplace(id, kMostChanges, kPeriodOfChanges).first->second;
  if (!changes.Admit(now)) return Admission::kTooManyChanges;
  announced_.insert_or_assign(id, vehicle);
  unstored_.insert(id);
  return is_new ? Admission::kAdmitted : Admission::kChanged;
}

bool VehicleRegistry::Retire(const std::string& vehicle_id) {
  if (announced_.erase(vehicle_id) == 0) return false;
  unstored_.insert(vehicle_id);
  return true;
}

void VehicleRegistry::Store() {
  if (unstored_.empty()) return;
  std::vector<VehicleStore::Change> changes;
  for (const std::string& id : unstored_) {
    const auto found = announced_.find(id);
    changes.push_back(
        {id, found == announced_.end() ? std::nullopt : std::optional(found->second)});
  }
  for (const std::string& id : store_.Save(changes)) unstored_.erase(id);
}

bool VehicleRegistry::HasUnstored() const {
  const HeldSlices* const held = storage_.held();
  return std::ranges::any_of(
      unstored_, [&](const std::string& id) { return held == nullptr || held->FenceOf(id); });
}

/// What this daemon has heard and not stored is newer.
void VehicleRegistry::ReadStored() {
  for (Vehicle& vehicle : store_.All()) {
    const std::string id = vehicle.vehicle_id;
    if (unstored_.contains(id)) continue;
    announced_.insert_or_assign(id, std::move(vehicle));
    changes_.try_emplace(id, kMostChanges, kPeriodOfChanges);
  }
}

std::vector<Vehicle> VehicleRegistry::Vehicles() const {
  std::vector<Vehicle> vehicles;
  for (const auto& [id, vehicle] : configured_) vehicles.push_back(vehicle);
  for (const auto& [id, vehicle] : announced_) {
    if (Admits(id) && !IsConfigured(id)) vehicles.push_back(vehicle);
  }
  return vehicles;
}

bool VehicleRegistry::Contains(const std::string& vehicle_id) const {
  return IsConfigured(vehicle_id) || (announced_.contains(vehicle_id) && Admits(vehicle_id));
}

bool VehicleRegistry::IsConfigured(const std::string& vehicle_id) const {
  return configured_.contains(vehicle_id);
}

bool VehicleRegistry::Admits(const std::string& vehicle_id) const {
  return std::ranges::any_of(rule_.admit, [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), vehicle_id.c_str(), 0) == 0;
  });
}

}  // namespace telltale
