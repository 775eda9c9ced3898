#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "telltale/core/base/result.hpp"

namespace telltale {

bool BeginsLikeZstdFrame(std::span<const std::uint8_t> bytes);

/// Inflates one zstd frame, which is to fill `out` exactly; false where it does not.
bool InflateZstdFrame(std::span<const std::uint8_t> compressed, std::vector<std::uint8_t>& out);

/// Inflates one zstd frame that states its length, at most `most` bytes, into `out`; false where it
/// is no such frame.
bool InflateZstdFrameOfItsLength(std::span<const std::uint8_t> compressed, std::size_t most,
                                 std::vector<std::uint8_t>& out);

/// Inflates a file of zstd frames into another. Returns whether the frames are whole: of a file
/// that is cut off, `into` holds what there is. Memory: the window of a frame, at most 128 MB.
/// Refuses when: a file cannot be read or written, or what it holds is no zstd.
Result<bool> InflateZstdFile(const std::filesystem::path& file, const std::filesystem::path& into);

}  // namespace telltale
