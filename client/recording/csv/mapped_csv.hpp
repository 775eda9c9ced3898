#pragma once

#include <filesystem>

#include "telltale/client/recording/source_log.hpp"
#include "telltale/idl/codec/mapping_file.hpp"

namespace telltale {

/// One CSV file with columns of any names, of which a mapping says what they hold. The first row
/// names the columns; comma, semicolon or tab separates them, whichever the first row has most of;
/// with semicolons a decimal comma is understood. An empty cell is no value, so channels may have
/// rates of their own. Of `options` the memory and the
/// progress count.
/// Channels may be without a value. Refuses when: the file cannot be read, lacks a column that the
/// mapping names, or the mapping names a topic or no column of times.
Result<SourceLog> ReadMappedCsv(const std::filesystem::path& file, const Mapping& mapping,
                                const SourceOptions& options = {});

}  // namespace telltale
