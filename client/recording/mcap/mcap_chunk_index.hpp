#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace telltale {

/// Where the messages of each channel begin in a chunk, as the index records behind it say.
class McapChunkIndex {
 public:
  enum class Outcome { kUnknown, kWhole, kIncomplete };

  /// Reads the index records that `behind` begins with, up to the first record of another kind.
  /// Incomplete: more bytes are needed to see their end. Assumes: the bytes outlive it.
  Outcome Read(std::span<const std::uint8_t> behind);

  /// How many bytes of the inflated chunk, from its start, hold all messages of channels of use;
  /// `size` where the index does not tell. Requires: Read() gave kWhole.
  /// `is_of_use`: nothing for a channel that is not defined.
  std::uint64_t BytesOfUse(
      std::uint64_t size,
      const std::function<std::optional<bool>(std::uint16_t channel)>& is_of_use) const;

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::span<const std::uint8_t> entries;  ///< time and offset, eight bytes each
  };

  std::vector<Channel> channels_;
};

}  // namespace telltale
