#pragma once

#include <filesystem>

#include "telltale/idl/codec/daemon_config.hpp"

namespace telltale {

/// Reads the configuration file and the vehicle files that it names, whose vehicles join those of
/// the configuration, and the mappings of its sources. A relative path starts at the folder of the
/// configuration file.
Decoded<DaemonConfig> LoadConfiguration(const std::filesystem::path& file);

}  // namespace telltale
