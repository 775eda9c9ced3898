#pragma once

#include <filesystem>

#include "telltale/idl/codec/daemon_config.hpp"

namespace telltale {

/// The daemon's configuration, the vehicles of its vehicle files among its vehicles. Relative
/// vehicle files are looked for beside the configuration file.
Decoded<DaemonConfig> LoadConfiguration(const std::filesystem::path& file);

}  // namespace telltale
