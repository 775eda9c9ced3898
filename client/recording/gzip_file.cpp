#include "telltale/client/recording/gzip_file.hpp"

#include <cstddef>
#include <memory>
#include <vector>

#include <zlib.h>

#include "telltale/client/recording/inflated_file.hpp"

namespace telltale {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 18;

struct CloseGzip {
  void operator()(gzFile file) const { gzclose(file); }
};

}  // namespace

bool BeginsLikeGzipFile(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0x1F && bytes[1] == 0x8B && bytes[2] == Z_DEFLATED;
}

Result<bool> InflateGzipFile(const std::filesystem::path& file, const std::filesystem::path& into,
                             std::uint64_t most_bytes) {
  const std::unique_ptr<gzFile_s, CloseGzip> in(gzopen(file.c_str(), "rb"));
  if (!in) return Refuse(file.string(), "cannot be opened", "check the path and its permissions");
  InflatedFile out(file, into, most_bytes);
  std::vector<char> block(kPieceBytes);
  int got = 1;
  bool is_written = true;
  while (is_written && got > 0) {
    got = gzread(in.get(), block.data(), static_cast<unsigned>(block.size()));
    if (got > 0) is_written = out.Write(block.data(), static_cast<std::size_t>(got));
  }
  int fault = Z_OK;
  gzerror(in.get(), &fault);
  const bool is_cut_off = fault == Z_BUF_ERROR;
  if (fault != Z_OK && fault != Z_STREAM_END && !is_cut_off) {
    return Refuse(file.string(), "cannot be decompressed as gzip", "copy the file again");
  }
  if (auto refusal = out.Close()) return tl::unexpected(*std::move(refusal));
  return !is_cut_off;
}

}  // namespace telltale
