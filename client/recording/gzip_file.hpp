#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "telltale/client/recording/inflated_file.hpp"
#include "telltale/core/base/result.hpp"

namespace telltale {

bool BeginsLikeGzipFile(std::span<const std::uint8_t> bytes);

/// Inflates a gzip file into another. Returns whether it is whole: of a file that is cut off,
/// `into` holds what there is. Refuses when: a file cannot be read or written, or is no gzip file,
/// or it holds more than an InflatedFile takes.
Result<bool> InflateGzipFile(const std::filesystem::path& file, const std::filesystem::path& into,
                             std::uint64_t most_bytes = kMostInflatedBytes);

}  // namespace telltale
