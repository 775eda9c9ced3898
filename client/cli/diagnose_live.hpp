#pragma once

#include <string>

#include "cli/diagnose_arguments.hpp"
#include "cli/live_options.hpp"

namespace telltale {

/// Asks the daemon to diagnose the vehicle's window and writes the answer as `arguments` say.
/// Throws: RefusedError when the window cannot answer, std::runtime_error when nobody answers or
/// the daemon failed.
void DiagnoseLive(const std::string& vehicle_id, const DiagnoseArguments& arguments,
                  const LiveOptions& live);

}  // namespace telltale
