#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// A ROS 1 recording (.bag, version 2.0): chunks compressed by bz2, lz4 or not at all, indexed or
/// not, whole or cut off. The messages are those that RosRecording takes, under their names of
/// ROS 1.
/// Memory: one chunk, compressed and not. Chunks that inflate to more than 64 MB are counted.
/// Channels may be missing. Refuses when: the file cannot be read, or is not a bag of version 2.0.
/// Source: ROS wiki, "Bags/Format/2.0".
Result<SourceLog> ReadRosbag1(const std::filesystem::path& file, const SourceOptions& options = {});

/// Everything that can be had from these bytes, taken in blocks of so many; never fails.
/// Requires: block > 0; options.Validate() is empty.
SourceLog ParseRosbag1(std::span<const std::uint8_t> bytes, std::size_t block,
                       const SourceOptions& options);

/// Whether bytes begin like a ROS 1 recording.
bool BeginsLikeRosbag1(std::span<const std::uint8_t> bytes);

}  // namespace telltale
