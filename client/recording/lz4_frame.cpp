#include "telltale/client/recording/lz4_frame.hpp"

#include <cstddef>
#include <new>

#include <lz4frame.h>

namespace telltale {

struct Lz4Inflater::Context {
  Context() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&lz4, LZ4F_VERSION)) != 0) {
      throw std::bad_alloc();
    }
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { LZ4F_freeDecompressionContext(lz4); }

  LZ4F_dctx* lz4 = nullptr;
};

/// How far a frame went.
struct Lz4Inflater::Reached {
  bool is_full = false;
  bool is_done = false;  ///< the frame has ended
};

Lz4Inflater::Lz4Inflater() : context_(std::make_unique<Context>()) {}
Lz4Inflater::~Lz4Inflater() = default;

Lz4Inflater::Reached Lz4Inflater::InflateUntilFull(std::span<const std::uint8_t> compressed,
                                                   std::span<std::uint8_t> out,
                                                   Lz4Checksums checksums) {
  LZ4F_resetDecompressionContext(context_->lz4);
  LZ4F_decompressOptions_t options{};
  options.stableDst = 1;
  options.skipChecksums = checksums == Lz4Checksums::kSkip ? 1 : 0;
  std::size_t from = 0;
  std::size_t to = 0;
  Reached reached;
  while (!reached.is_done && from < compressed.size()) {
    std::size_t taken = compressed.size() - from;
    std::size_t given = out.size() - to;
    const std::size_t hint = LZ4F_decompress(context_->lz4, out.data() + to, &given,
                                             compressed.data() + from, &taken, &options);
    if (LZ4F_isError(hint) != 0 || (taken == 0 && given == 0)) break;
    from += taken;
    to += given;
    reached.is_done = hint == 0;
  }
  reached.is_full = to == out.size();
  return reached;
}

bool Lz4Inflater::Inflate(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out,
                          Lz4Checksums checksums) {
  const Reached reached = InflateUntilFull(compressed, out, checksums);
  return reached.is_full && reached.is_done;
}

bool Lz4Inflater::InflateStart(std::span<const std::uint8_t> compressed,
                               std::span<std::uint8_t> out) {
  return InflateUntilFull(compressed, out, Lz4Checksums::kCompare).is_full;
}

}  // namespace telltale
