#pragma once

#include <string>

#include "telltale/client/cli/identify_arguments.hpp"
#include "telltale/client/cli/live_options.hpp"

namespace telltale {

/// Asks the daemon to identify the vehicle from its window and writes the answer as `arguments`
/// say. Throws: RefusedError when the window cannot answer, UsageError for an option the daemon
/// decides, std::runtime_error when nobody answers or the daemon failed.
void IdentifyLive(const std::string& vehicle_id, const IdentifyArguments& arguments,
                  const LiveOptions& live);

}  // namespace telltale
