#include "telltale/client/recording/lz4_frame.hpp"

#include <cstddef>

#include <lz4frame.h>

namespace telltale {

bool InflateLz4Frame(std::span<const std::uint8_t> compressed, std::vector<std::uint8_t>& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return false;
  std::size_t from = 0;
  std::size_t to = 0;
  bool is_done = false;
  while (!is_done && from < compressed.size()) {
    std::size_t taken = compressed.size() - from;
    std::size_t given = out.size() - to;
    const std::size_t hint = LZ4F_decompress(context, out.data() + to, &given,
                                             compressed.data() + from, &taken, nullptr);
    if (LZ4F_isError(hint) != 0 || (taken == 0 && given == 0)) break;
    from += taken;
    to += given;
    is_done = hint == 0;
  }
  LZ4F_freeDecompressionContext(context);
  return is_done && to == out.size();
}

}  // namespace telltale
