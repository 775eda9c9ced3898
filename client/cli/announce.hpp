#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/fleet/vehicle_announcer.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Announces each vehicle for as long as what this returns lives.
std::vector<VehicleAnnouncer> Announce(const Participant& participant,
                                       const std::vector<Vehicle>& vehicles);

/// Waits until daemons serve all these vehicles. Throws std::runtime_error, which names one and
/// says what to do, where that takes longer than the time-out. `waiting`: as AwaitServed.
void RequireServed(const Participant& participant, const std::set<std::string>& vehicle_ids,
                   const LiveOptions& live, const std::function<void(std::size_t)>& waiting = {});

}  // namespace telltale
