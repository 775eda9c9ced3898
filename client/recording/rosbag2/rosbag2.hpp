#pragma once

#include <filesystem>

#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// A rosbag2 recording: a folder of .db3 or .mcap files, with or without metadata.yaml, or one .db3
/// file. Files of a folder count as one recording, in the order of their names.
/// Refuses when: a file cannot be read, holds no rosbag2 tables, is compressed as a whole, or the
/// recording lacks a channel.
Result<SourceLog> ReadRosbag2(const std::filesystem::path& path, const SourceOptions& options = {});

/// Whether a folder holds files of rosbag2.
bool IsRosbag2Folder(const std::filesystem::path& path);

}  // namespace telltale
