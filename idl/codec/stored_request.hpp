#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"

namespace telltale {

/// A request of any kind that takes time.
using AnyRequest = std::variant<IdentifyRequest, DiagnoseRequest, FleetRequest>;

const std::string& CorrelationIdOf(const AnyRequest& request);

/// The bytes of proto/stored_request.proto. `now_unix_s` is when the request came: its deadline
/// counts from then. Requires of a FleetRequest the command kRefresh.
std::string SerialiseRequest(const AnyRequest& request, double now_unix_s);

/// The way back, with the deadline that is left; below 0 where it has passed. Refuses what is no
/// such message, and as Decode() of the request's wire type.
Decoded<AnyRequest> ParseStoredRequest(std::string_view bytes, double now_unix_s);

}  // namespace telltale
