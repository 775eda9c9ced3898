#pragma once

#include "telltale/core/identification/options.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

/// The options that a request names, and the daemon's settings and defaults for the others. The
/// workers share the processors.
IdentifyOptions OptionsOf(const IdentifyRequest& request, const IdentificationSettings& settings);

}  // namespace telltale
