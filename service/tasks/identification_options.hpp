#pragma once

#include "telltale/core/identification/options.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

/// Whether neither the request nor the settings name a structure, and no option of the request
/// belongs to one.
bool LeavesStructureToData(const IdentifyRequest& request, const IdentificationSettings& settings);

/// The options that a request names, and the daemon's settings and defaults for the others. The
/// workers share the processors.
IdentifyOptions OptionsOf(const IdentifyRequest& request, const IdentificationSettings& settings);

}  // namespace telltale
