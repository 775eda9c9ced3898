#pragma once

#include <memory>
#include <optional>
#include <string>

#include "telltale/client/bridge/live_source.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/idl/codec/daemon_config.hpp"

namespace telltale {

/// What no source can be made of: a wrong address, namespace or pattern of vehicle ids. The field
/// is named below the source.
std::optional<CodecError> SourceFault(const SourceSettings& settings);

/// "mavlink udp:0.0.0.0:14550", "ros2 /{vehicle}".
std::string SourceName(const SourceSettings& settings);

/// Requires: SourceFault(settings) is empty. Throws where it cannot be opened now.
std::unique_ptr<LiveSource> MakeSource(const SourceSettings& settings,
                                       const Participant& participant,
                                       const LiveSource::Report& report);

}  // namespace telltale
