#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// What an MCAP file begins and ends with.
inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

/// Whether bytes begin with MCAP's magic.
bool BeginsLikeMcap(std::span<const std::uint8_t> bytes);

/// One message of an MCAP file with what its channel says of it.
struct McapMessage {
  std::string_view topic;
  std::string_view schema;    ///< name of the message's type; empty without a schema
  std::string_view encoding;  ///< "cdr", "json", ...
  std::int64_t log_time_ns = 0;
  std::span<const std::uint8_t> data;
  std::string_view definition;  ///< of the type as .msg, where the schema has it or IDL
};

/// What a file held besides whole messages.
struct McapDamage {
  std::uint64_t messages = 0;           ///< whole ones, for comparison
  std::uint64_t unreadable_chunks = 0;  ///< wrong checksum, length or compression
  std::uint64_t overlong_records = 0;   ///< too long to be held in memory
  std::uint64_t unknown_channels = 0;   ///< messages of a channel that is nowhere defined
  std::uint64_t truncated_bytes = 0;    ///< of a record that the end cuts off

  /// "; 1 unreadable chunk" and so on; empty where nothing is wrong.
  std::string Summary() const;
};

/// Visits the messages of an MCAP file in the order they stand there: chunked or not, compressed
/// with zstd, lz4 or not at all, with or without an index, cut off or whole.
/// Memory: one chunk, compressed and not. Records longer than 128 MB and chunks that inflate to
/// more than 64 MB are passed over and counted. Refuses when: the file cannot be read or does not
/// begin with MCAP's magic. Source: MCAP file format specification, version 0.
Result<McapDamage> ForEachMcapMessage(const std::filesystem::path& file,
                                      const std::function<void(const McapMessage&)>& visit);

/// Everything that can be had from these bytes, taken in blocks of so many; never fails.
/// Requires: block > 0; options.Validate() is empty.
SourceLog ParseMcap(std::span<const std::uint8_t> bytes, std::size_t block,
                    const SourceOptions& options);

/// An MCAP file of ROS 2 (CDR), of ROS 1, or of the BlueOS recorder (MAVLink messages as JSON);
/// with a mapping, of any messages of ROS or JSON. Refuses when: ForEachMcapMessage() does, or a
/// channel is missing.
Result<SourceLog> ReadMcap(const std::filesystem::path& file, const SourceOptions& options = {});

}  // namespace telltale
