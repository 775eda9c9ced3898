#pragma once

#include <string>

#include "telltale/client/cli/diagnose_arguments.hpp"
#include "telltale/client/cli/live_options.hpp"

namespace telltale {

/// Asks the daemon to diagnose the vehicle's window and writes the answer as `arguments` say.
/// Throws: RefusedError when the window cannot answer, std::runtime_error when nobody answers or
/// the daemon failed.
void DiagnoseLive(const std::string& vehicle_id, const DiagnoseArguments& arguments,
                  const LiveOptions& live);

}  // namespace telltale
