#include "telltale/client/recording/zstd_frame.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
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

/// Where the next piece of what a file holds is to be put.
using RoomForPiece = std::function<std::span<std::uint8_t>()>;

/// Told how long the piece is; false: no more is wanted.
using PieceTaker = std::function<bool(std::size_t inflated)>;

/// Whether the frames of the file are whole.
Result<bool> InflateFrames(const std::filesystem::path& file, const RoomForPiece& room,
                           const PieceTaker& take, const ReadProgress& progress) {
  const ZstdContext inflater = MakeContext();
  std::size_t wanted = 1;  // more of the frame
  bool is_zstd = true;
  bool is_taken = true;
  const auto read = ReadInBlocks(
      file,
      [&](std::span<const std::uint8_t> bytes, bool) {
        ZSTD_inBuffer from{bytes.data(), bytes.size(), 0};
        bool holds_back = false;  // what the room is too small for
        while (is_zstd && is_taken && (from.pos < from.size || holds_back)) {
          const std::span<std::uint8_t> out = room();
          ZSTD_outBuffer to{out.data(), out.size(), 0};
          wanted = ZSTD_decompressStream(inflater.get(), &to, &from);
          is_zstd = ZSTD_isError(wanted) == 0;
          holds_back = wanted != 0 && to.pos == to.size;
          is_taken = take(to.pos);
        }
        return bytes.size();
      },
      progress);
  if (!read) return tl::unexpected(read.error());
  if (!is_zstd) {
    return Refuse(file.string(), "cannot be decompressed as zstd", "copy the file again");
  }
  return wanted == 0;
}

}  // namespace

bool BeginsLikeZstdFrame(std::span<const std::uint8_t> bytes) {
  // Asked of every message: of a length that is known here, memcmp is one comparison.
  return bytes.size() >= kMagic.size() &&
         std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
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
  std::vector<std::uint8_t> piece(ZSTD_DStreamOutSize());
  auto is_whole = InflateFrames(
      file, [&] { return std::span(piece); },
      [&](std::size_t inflated) { return out.Write(piece.data(), inflated); }, nullptr);
  if (!is_whole) return is_whole;
  if (auto refusal = out.Close()) return tl::unexpected(*std::move(refusal));
  return is_whole;
}

Result<bool> ReadZstdInBlocks(const std::filesystem::path& file, const BlockConsumer& consume,
                              const ReadProgress& progress, std::uint64_t most_bytes) {
  BlockBuffer block;
  std::uint64_t total = 0;
  bool has_room = true;
  auto is_whole = InflateFrames(
      file,
      [&] {
        has_room = !block.IsFull() || block.Grow();
        return has_room ? block.Room() : std::span<std::uint8_t>();
      },
      [&](std::size_t inflated) {
        total += inflated;
        if (!has_room || total > most_bytes) return false;
        block.HandOver(inflated, consume, false);
        return true;
      },
      progress);
  if (!is_whole) return is_whole;
  if (!has_room) return tl::unexpected(TooLongItem(file));
  if (total > most_bytes) return tl::unexpected(TooMuchInflated(file, most_bytes));
  block.HandOver(0, consume, true);
  return is_whole;
}

}  // namespace telltale
