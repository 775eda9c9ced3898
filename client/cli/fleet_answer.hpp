#pragma once

#include <functional>
#include <string>
#include <vector>

#include "telltale/client/cli/live_options.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"

namespace telltale {

/// The answer of the daemon, or of all that share the fleet; of those of them that answered in
/// time, where others did not. `progress` runs on the calling thread. Throws as RequirePublished().
FleetReply AskFleet(FleetRequest request, const LiveOptions& live,
                    const std::function<void(const FleetProgress&)>& progress = {});

/// Throws std::runtime_error where a daemon that shares the fleet did not answer `request`.
void RequireWholeFleet(const FleetRequest& request, const FleetReply& reply);

std::string VehicleListTable(const std::vector<VehicleSummary>& vehicles);
std::string ModelHistoryTable(const std::vector<ModelSummary>& models);

/// "published 12, 1 of them ERROR; unchanged 3; refused 2" and, below, each vehicle that is neither
/// published with verdict OK nor unchanged, with its reason.
std::string RefreshSummaryText(const std::vector<RefreshedVehicle>& vehicles);

/// "OK" and the like; "-" where there is none.
std::string VerdictText(PromotionVerdict verdict);

}  // namespace telltale
