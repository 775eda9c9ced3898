#include "telltale/service/refresh/refresh_run.hpp"

#include <algorithm>
#include <utility>

namespace telltale {

RefreshRun::RefreshRun(std::string correlation_id, const std::vector<std::string>& vehicle_ids,
                       SliceSet slices)
    : correlation_id_(std::move(correlation_id)), slices_(slices), unfinished_(vehicle_ids.size()) {
  for (const std::string& vehicle_id : vehicle_ids) {
    places_.emplace(vehicle_id, vehicles_.size());
    vehicles_.push_back({vehicle_id, RefreshState::kWaiting, 0, PromotionVerdict::kUnknown, ""});
    changed_.insert(vehicle_id);
  }
  followers_.insert(correlation_id_);
}

double RefreshRun::ElapsedS() const {
  const auto until = finished() ? ended_ : Clock::now();
  return std::chrono::duration<double>(until - begun_).count();
}

const RefreshedVehicle* RefreshRun::NextWaiting() const {
  for (std::size_t i = next_waiting_; i < vehicles_.size(); ++i) {
    if (vehicles_[i].state == RefreshState::kWaiting) return &vehicles_[i];
  }
  return nullptr;
}

void RefreshRun::Update(const RefreshedVehicle& vehicle) {
  const auto place = places_.find(vehicle.vehicle_id);
  if (place == places_.end()) return;
  RefreshedVehicle& held = vehicles_[place->second];
  if (IsFinal(held.state)) return;
  if (held.state == RefreshState::kRunning) --running_;
  held = vehicle;
  if (held.state == RefreshState::kRunning) ++running_;
  if (held.state == RefreshState::kWaiting) next_waiting_ = std::min(next_waiting_, place->second);
  changed_.insert(held.vehicle_id);
  if (IsFinal(held.state) && --unfinished_ == 0) ended_ = Clock::now();
  while (next_waiting_ < vehicles_.size() &&
         vehicles_[next_waiting_].state != RefreshState::kWaiting) {
    ++next_waiting_;
  }
}

void RefreshRun::CancelWaiting() {
  while (const RefreshedVehicle* waiting = NextWaiting()) {
    RefreshedVehicle cancelled = *waiting;
    cancelled.state = RefreshState::kCancelled;
    Update(cancelled);
  }
}

std::vector<RefreshedVehicle> RefreshRun::TakeChanges() {
  std::vector<RefreshedVehicle> changes;
  for (const std::string& vehicle_id : std::exchange(changed_, {})) {
    changes.push_back(vehicles_[places_.find(vehicle_id)->second]);
  }
  return changes;
}

}  // namespace telltale
