#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// With what is made of it a block stays in the second cache of a processor.
inline constexpr std::size_t kBlockBytes = std::size_t{256} << 10;

/// As many bytes of a file's beginning as tell its format, or all of a shorter one; none of a file
/// that cannot be read.
std::vector<std::uint8_t> BeginningOf(const std::filesystem::path& file);

/// Takes bytes and returns how many it is done with; the rest comes again in front of what follows.
/// `at_end`: nothing follows.
using BlockConsumer = std::function<std::size_t(std::span<const std::uint8_t> bytes, bool at_end)>;

/// Told how much of a file has been read, as a share of it.
using ReadProgress = std::function<void(double share)>;

/// Bytes on their way to a consumer. What it is not done with stays in front of what comes.
class BlockBuffer {
 public:
  /// Where more bytes may be put.
  std::span<std::uint8_t> Room() { return {bytes_.get() + filled_, size_ - filled_}; }
  bool IsFull() const { return filled_ == size_; }

  /// Makes room for an item that is longer than the block. False: it is longer than any is.
  bool Grow();

  /// Hands over what is there with `more` bytes that have been put in Room().
  void HandOver(std::size_t more, const BlockConsumer& consume, bool at_end);

 private:
  static constexpr std::size_t kLongestItem = std::size_t{256} << 20;

  std::size_t size_ = kBlockBytes;
  std::unique_ptr<std::uint8_t[]> bytes_ = std::make_unique_for_overwrite<std::uint8_t[]>(size_);
  std::size_t filled_ = 0;
};

/// Why a file is not read whose item a BlockBuffer has no room for.
Refusal TooLongItem(const std::filesystem::path& file);

/// Hands a file over in blocks, so that memory does not grow with it; a consumer that needs more
/// bytes than a block gets a longer one. Returns the file's length in bytes. `progress` may be
/// null. Refuses when: the file cannot be opened or read, or an item is longer than 256 MB.
Result<std::uint64_t> ReadInBlocks(const std::filesystem::path& file, const BlockConsumer& consume,
                                   const ReadProgress& progress = nullptr);

/// Hands bytes over in the same way, `block` more each time. Returns how many the consumer is done
/// with. Requires: block > 0.
template <class Consume>
std::size_t TakeInBlocks(std::span<const std::uint8_t> bytes, std::size_t block, Consume consume) {
  std::size_t done = 0;
  for (std::size_t end = 0; end < bytes.size();) {
    end = std::min(end + block, bytes.size());
    done += consume(bytes.subspan(done, end - done), end == bytes.size());
  }
  return done;
}

/// Hands over the whole lines of a text, without their ends; the last one may lack its end. Returns
/// the bytes of the lines, as a BlockConsumer does.
template <class TakeLine>
std::size_t TakeLines(std::span<const std::uint8_t> bytes, bool at_end, TakeLine take) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos && !at_end) return at;
    const std::size_t stop = std::min(end, text.size());
    take(text.substr(at, stop - at));
    at = stop + 1;
  }
  return text.size();
}

}  // namespace telltale
