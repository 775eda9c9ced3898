#pragma once

#include <string>
#include <vector>

#include "telltale/idl/codec/messages/fleet_exchange.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/published_models.hpp"

namespace telltale {

/// Every vehicle that is served, with its newest model.
std::vector<VehicleSummary> SummariesOf(const Fleet& fleet, const PublishedModels& models);

ModelSummary SummaryOf(const PublishedModel& model);

/// The vehicles that a request to refresh names, in order, without those that its conditions leave
/// out or another daemon serves. Vehicles that nobody serves stay: their identification fails and
/// says so.
std::vector<std::string> VehiclesToRefresh(const FleetRequest& request, const Fleet& fleet,
                                           const PublishedModels& models);

}  // namespace telltale
