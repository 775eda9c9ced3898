#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/inflated_file.hpp"
#include "telltale/core/base/result.hpp"

namespace telltale {

bool BeginsLikeZstdFrame(std::span<const std::uint8_t> bytes);

/// Inflates one zstd frame after the other, in memory that it keeps between them.
class ZstdInflater {
 public:
  ZstdInflater();
  ~ZstdInflater();

  /// A frame that is to fill `out` exactly; false where it does not.
  bool Inflate(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out);

  /// The start of a frame, until `out` is full; false where it does not fill it. What follows is
  /// not looked at.
  bool InflateStart(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out);

  /// A frame that states its length, at most `most` bytes; false where it is no such frame, or
  /// states more than its bytes can hold.
  bool InflateOfItsLength(std::span<const std::uint8_t> compressed, std::size_t most,
                          std::vector<std::uint8_t>& out);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Hands over in blocks what a file of zstd frames holds, as ReadInBlocks does of a file. Returns
/// whether the frames are whole: of a file that is cut off there is what comes before. Memory: the
/// window of a frame, at most 128 MB, and a block. Refuses when: the file cannot be read, what it
/// holds is no zstd, inflates to more than `most_bytes`, or has an item longer than 256 MB; a part
/// of it may have been handed over then.
Result<bool> ReadZstdInBlocks(const std::filesystem::path& file, const BlockConsumer& consume,
                              const ReadProgress& progress = nullptr,
                              std::uint64_t most_bytes = kMostInflatedBytes);

/// Inflates a file of zstd frames into another. Returns whether the frames are whole: of a file
/// that is cut off, `into` holds what there is. Memory: the window of a frame, at most 128 MB.
/// Refuses when: a file cannot be read or written, what it holds is no zstd, or
/// more than an InflatedFile takes.
Result<bool> InflateZstdFile(const std::filesystem::path& file, const std::filesystem::path& into,
                             std::uint64_t most_bytes = kMostInflatedBytes);

}  // namespace telltale
