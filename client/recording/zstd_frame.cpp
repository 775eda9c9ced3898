#include "telltale/client/recording/zstd_frame.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include <zstd.h>

#include "telltale/client/recording/block_reader.hpp"

namespace telltale {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic = {0x28, 0xB5, 0x2F, 0xFD};

using ZstdContext = std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)>;

ZstdContext MakeContext() {
  return {ZSTD_createDCtx(), &ZSTD_freeDCtx};
}

// A block takes four bytes or more and holds at most 128 KiB, RFC 8878, 3.1.1.2: a frame of a few
// bytes that states a gigabyte lies.
std::size_t MostInflated(std::size_t compressed) {
  constexpr std::size_t kLeastBlock = 4;
  constexpr std::size_t kMostOfBlock = 128 * 1024;
  return (compressed / kLeastBlock) * kMostOfBlock;
}

}  // namespace

bool BeginsLikeZstdFrame(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

struct ZstdInflater::Context {
  ZstdContext zstd = MakeContext();
};

ZstdInflater::ZstdInflater() : context_(std::make_unique<Context>()) {}
ZstdInflater::~ZstdInflater() = default;

bool ZstdInflater::Inflate(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out) {
  const std::size_t size = ZSTD_decompressDCtx(context_->zstd.get(), out.data(), out.size(),
                                               compressed.data(), compressed.size());
  return ZSTD_isError(size) == 0 && size == out.size();
}

bool ZstdInflater::InflateStart(std::span<const std::uint8_t> compressed,
                                std::span<std::uint8_t> out) {
  ZSTD_DCtx_reset(context_->zstd.get(), ZSTD_reset_session_only);
  ZSTD_inBuffer from{compressed.data(), compressed.size(), 0};
  ZSTD_outBuffer to{out.data(), out.size(), 0};
  std::size_t wanted = 1;  // more of the frame
  while (wanted != 0 && to.pos < to.size) {
    const std::size_t before = from.pos + to.pos;
    wanted = ZSTD_decompressStream(context_->zstd.get(), &to, &from);
    if (ZSTD_isError(wanted) != 0 || from.pos + to.pos == before) return false;
  }
  return to.pos == to.size;
}

bool ZstdInflater::InflateOfItsLength(std::span<const std::uint8_t> compressed, std::size_t most,
                                      std::vector<std::uint8_t>& out) {
  // What is no frame, or states no length, seems longer than any.
  const unsigned long long size = ZSTD_getFrameContentSize(compressed.data(), compressed.size());
  if (size > std::min(most, MostInflated(compressed.size()))) return false;
  out.resize(static_cast<std::size_t>(size));
  return Inflate(compressed, out);
}

Result<bool> InflateZstdFile(const std::filesystem::path& file, const std::filesystem::path& into,
                             std::uint64_t most_bytes) {
  InflatedFile out(file, into, most_bytes);
  const ZstdContext inflater = MakeContext();
  std::vector<std::uint8_t> inflated(ZSTD_DStreamOutSize());
  std::size_t wanted = 1;  // more of the frame
  bool is_zstd = true;
  bool is_written = true;
  const auto read = ReadInBlocks(file, [&](std::span<const std::uint8_t> bytes, bool) {
    ZSTD_inBuffer from{bytes.data(), bytes.size(), 0};
    bool holds_back = false;  // what the buffer has no room for
    while (is_zstd && is_written && (from.pos < from.size || holds_back)) {
      ZSTD_outBuffer to{inflated.data(), inflated.size(), 0};
      wanted = ZSTD_decompressStream(inflater.get(), &to, &from);
      is_zstd = ZSTD_isError(wanted) == 0;
      holds_back = wanted != 0 && to.pos == to.size;
      is_written = out.Write(to.dst, to.pos);
    }
    return bytes.size();
  });
  if (!read) return tl::unexpected(read.error());
  if (!is_zstd) {
    return Refuse(file.string(), "cannot be decompressed as zstd", "copy the file again");
  }
  if (auto refusal = out.Close()) return tl::unexpected(*std::move(refusal));
  return wanted == 0;
}

}  // namespace telltale
