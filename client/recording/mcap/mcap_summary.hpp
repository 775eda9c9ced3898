#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace telltale {

/// The last bytes of a file, in which the place of its summary stands.
inline constexpr std::size_t kMcapEnding = 9 + 20 + 8;  // footer and magic

/// Where the summary begins in a file of so many bytes, by its last kMcapEnding ones; nothing where
/// it has none.
std::optional<std::uint64_t> McapSummaryStart(std::span<const std::uint8_t> ending,
                                              std::uint64_t file_bytes);

/// The bytes from the summary to the end of a file; empty where there is no summary, it is longer
/// than 64 MB, or the file cannot be read.
std::vector<std::uint8_t> ReadMcapSummary(const std::filesystem::path& file);

/// Whether these bytes, a summary and what ends the file, are those that were written, by their
/// checksum; true where none was written.
bool IsSoundMcapSummary(std::span<const std::uint8_t> summary);

}  // namespace telltale
