#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/mcap/mcap_records.hpp"
#include "telltale/client/recording/message_taker.hpp"
#include "telltale/core/base/result.hpp"

namespace telltale {

/// Whether a file that begins with these bytes is MCAP, or MCAP that zstd has compressed as a
/// whole. A file of which zstd keeps the first block longer than the bytes seems to be none.
bool HoldsMcap(std::span<const std::uint8_t> beginning);

/// What a channel of an MCAP file says of its messages.
struct McapChannel {
  std::string_view topic;
  std::string_view schema;      ///< name of the messages' type; empty without a schema
  std::string_view encoding;    ///< "cdr", "json", ...
  std::string_view definition;  ///< of the type as .msg, where the schema has it or IDL
};

/// Who reads a file.
struct McapVisitor {
  /// Who takes a channel's messages; asked once, so that no message is looked up by its names.
  std::function<MessageTaker(const McapChannel&)> open;
  ReadProgress progress;  ///< null: nobody is told
};

/// What a file held besides whole messages.
struct McapDamage {
  std::uint64_t messages = 0;           ///< whole ones of use, for comparison
  std::uint64_t unreadable_chunks = 0;  ///< wrong checksum, length or compression
  std::uint64_t overlong_records = 0;   ///< too long to be held in memory
  std::uint64_t unknown_channels = 0;   ///< messages of a channel that is nowhere defined
  std::uint64_t truncated_bytes = 0;    ///< of a record that the end cuts off
  bool is_compressed_file_cut = false;  ///< what follows was not compressed whole

  /// "; 1 unreadable chunk" and so on; empty where nothing is wrong.
  std::string Summary() const;
};

/// Visits the messages of use of an MCAP file in the order they stand there: chunked or not,
/// compressed with zstd, lz4 or not at all, with or without an index, cut off or whole.
///
/// Of a chunk whose messages are indexed, only what is needed is inflated: nothing where no message
/// is of use, else up to the last one that is. This needs the summary at the end of the file,
/// because a chunk that is passed over may define channels; without one all chunks are inflated.
/// Checksums of chunks that are inflated whole are compared.
/// A file that zstd has compressed as a whole is inflated while it is read, all of it.
/// Memory: one chunk, compressed and not. Records longer than 128 MB and chunks that inflate to
/// more than 64 MB are passed over and counted. Refuses when: the file cannot be read or does not
/// begin with MCAP's magic. Source: MCAP file format specification, version 0.
Result<McapDamage> ForEachMcapMessage(const std::filesystem::path& file,
                                      const McapVisitor& visitor);

/// The same of the bytes of a file, taken in blocks of so many; nothing where they do not begin
/// with MCAP's magic. Requires: block > 0.
McapDamage ForEachMcapMessage(std::span<const std::uint8_t> bytes, std::size_t block,
                              const McapVisitor& visitor);

}  // namespace telltale
