#pragma once

#include <filesystem>

#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// A rosbag2 recording: a folder of .db3 or .mcap files, with or without metadata.yaml, or one such
/// file. Files of a folder count as one recording, in the order of their names and numbers.
/// Messages may be compressed one by one with zstd, and files as a whole (.db3.zstd): these are
/// inflated one after the other into the folder for temporary files, and removed from there.
/// Channels may be missing. Refuses when: a file cannot be read or inflated, or holds neither
/// rosbag2 tables nor MCAP.
Result<SourceLog> ReadRosbag2(const std::filesystem::path& path, const SourceOptions& options = {});

/// Whether a folder holds files of rosbag2.
bool IsRosbag2Folder(const std::filesystem::path& path);

}  // namespace telltale
