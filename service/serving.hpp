#pragma once

#include <optional>
#include <string>

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/daemon_config.hpp"

namespace telltale {

/// Serves the vehicles of a configuration until SIGINT or SIGTERM; SIGHUP reads them anew from its
/// file. Returns false where the daemon ended by itself, because it can receive no telemetry any
/// more. Throws std::exception where it cannot begin: a port that is taken, a directory that cannot
/// be written.
bool Serve(DaemonConfig config, const std::string& config_file);

/// Computes coverage checks and diagnoses for the daemons of the same database until SIGINT or
/// SIGTERM. Refuses a configuration without `workers`.
std::optional<CodecError> ServeAsWorker(const DaemonConfig& config, const std::string& config_file);

}  // namespace telltale
