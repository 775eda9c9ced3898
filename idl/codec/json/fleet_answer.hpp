#pragma once

#include <span>
#include <string>
#include <string_view>

#include "telltale/idl/codec/messages/fleet_exchange.hpp"

namespace telltale {

/// JSON of proto/fleet_answer.proto.
std::string PrintVehicleListJson(std::span<const VehicleSummary> vehicles);
std::string PrintModelHistoryJson(std::string_view vehicle_id,
                                  std::span<const ModelSummary> models);
std::string PrintRefreshJson(std::string_view refresh_id, const FleetReply& reply);

}  // namespace telltale
