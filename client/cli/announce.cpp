#include "telltale/client/cli/announce.hpp"

#include <stdexcept>

#include "telltale/client/cli/table.hpp"
#include "telltale/client/fleet/served_vehicles.hpp"

namespace telltale {

std::vector<VehicleAnnouncer> Announce(const Participant& participant,
                                       const std::vector<Vehicle>& vehicles) {
  std::vector<VehicleAnnouncer> announcers;
  for (const Vehicle& vehicle : vehicles) {
    announcers.emplace_back(participant, vehicle.vehicle_id).Announce(vehicle);
  }
  return announcers;
}

void RequireServed(const Participant& participant, const std::set<std::string>& vehicle_ids,
                   const LiveOptions& live, const std::function<void(std::size_t)>& waiting) {
  const auto unserved = AwaitServed(participant, vehicle_ids, live.Timeout(), waiting);
  if (unserved.empty()) return;
  const std::string others =
      unserved.size() == 1
          ? ""
          : " and " + Counted(unserved.size() - 1, "other vehicle", "other vehicles");
  throw std::runtime_error("no daemon on domain " + std::to_string(live.domain) + " serves " +
                           *unserved.begin() + others + " within " + Fixed(live.timeout_s, 0) +
                           " s: does announced { admit: ... } of its configuration have the id, "
                           "and what does its log say of the announcement?");
}

}  // namespace telltale
