#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace telltale {

/// Whether the checksums in a frame are compared: where its content has one of its own besides,
/// they only cost time.
enum class Lz4Checksums { kCompare, kSkip };

/// Inflates one lz4 frame after the other, in memory that it keeps between them.
class Lz4Inflater {
 public:
  Lz4Inflater();
  ~Lz4Inflater();

  /// A frame that is to fill `out` exactly; false where it does not.
  bool Inflate(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out,
               Lz4Checksums checksums = Lz4Checksums::kCompare);

  /// The start of a frame, until `out` is full; false where it does not fill it. What follows is
  /// not looked at.
  bool InflateStart(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out);

 private:
  struct Context;
  struct Reached;
  Reached InflateUntilFull(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out,
                           Lz4Checksums checksums);

  std::unique_ptr<Context> context_;
};

}  // namespace telltale
