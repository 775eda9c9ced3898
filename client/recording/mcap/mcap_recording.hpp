#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// Everything that can be had from these bytes, taken in blocks of so many; never fails.
/// Requires: block > 0; options.Validate() is empty.
SourceLog ParseMcap(std::span<const std::uint8_t> bytes, std::size_t block,
                    const SourceOptions& options);

/// An MCAP file of ROS 2 (CDR), of ROS 1, or of the BlueOS recorder (MAVLink messages as JSON);
/// with a mapping, of any messages of ROS or JSON. Channels may be missing. Refuses when:
/// ForEachMcapMessage() does.
Result<SourceLog> ReadMcap(const std::filesystem::path& file, const SourceOptions& options = {});

}  // namespace telltale
