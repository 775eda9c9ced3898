#include "telltale/client/fleet/shared_fleet_reply.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace telltale {
namespace {

/// Failed is what a daemon says of a vehicle that it knows nothing of.
bool SaysLess(const RefreshedVehicle& one, const RefreshedVehicle& other) {
  return one.state == RefreshState::kFailed && other.state != RefreshState::kFailed;
}

bool SaysLess(const VehicleSummary&, const VehicleSummary&) {
  return false;
}

/// In the order of their ids, as one daemon lists them.
template <class Vehicle>
void Merge(std::vector<Vehicle>& vehicles, const std::vector<Vehicle>& more) {
  for (const Vehicle& vehicle : more) {
    const auto place =
        std::ranges::lower_bound(vehicles, vehicle.vehicle_id, {}, &Vehicle::vehicle_id);
    if (place == vehicles.end() || place->vehicle_id != vehicle.vehicle_id) {
      vehicles.insert(place, vehicle);
    } else if (!SaysLess(vehicle, *place)) {
      *place = vehicle;
    }
  }
}

}  // namespace

SliceSet SlicesAskedBy(const FleetRequest& request) {
  if (request.vehicle_ids.empty()) return kAllSlices;
  SliceSet slices = 0;
  for (const std::string& vehicle_id : request.vehicle_ids) slices |= SetOf(SliceOf(vehicle_id));
  return slices;
}

SliceSet UnansweredSlices(const FleetRequest& request, const FleetReply& reply) {
  return reply.slices == 0 ? 0 : SlicesAskedBy(request) & ~reply.slices;
}

void SharedFleetReply::Add(const FleetReply& reply) {
  const bool succeeds = reply.outcome == ReplyOutcome::kAnswered;
  if (!reply_) {
    reply_ = reply;
    std::ranges::sort(reply_->vehicles, {}, &VehicleSummary::vehicle_id);
    std::ranges::sort(reply_->refreshed, {}, &RefreshedVehicle::vehicle_id);
    return;
  }
  if (succeeds && reply_->outcome != ReplyOutcome::kAnswered) {
    reply_->outcome = reply.outcome;
    reply_->message = reply.message;
    reply_->models = reply.models;
    reply_->later_models = reply.later_models;
  }
  Merge(reply_->vehicles, reply.vehicles);
  Merge(reply_->refreshed, reply.refreshed);
  reply_->elapsed_s = std::max(reply_->elapsed_s, reply.elapsed_s);
  reply_->slices = reply.slices == 0 ? 0 : reply_->slices | reply.slices;
}

/// Who cancels something waits for nobody else once it is cancelled.
bool SharedFleetReply::IsComplete() const {
  if (!reply_) return false;
  const bool is_cancelled =
      request_.command == FleetCommand::kCancel && reply_->outcome == ReplyOutcome::kAnswered;
  return is_cancelled || UnansweredSlices(request_, *reply_) == 0;
}

}  // namespace telltale
