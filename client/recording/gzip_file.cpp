#include "telltale/client/recording/gzip_file.hpp"

#include <cstddef>
#include <fstream>
#include <memory>
#include <vector>

#include <zlib.h>

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

Result<bool> InflateGzipFile(const std::filesystem::path& file, const std::filesystem::path& into) {
  const std::unique_ptr<gzFile_s, CloseGzip> in(gzopen(file.c_str(), "rb"));
  if (!in) return Refuse(file.string(), "cannot be opened", "check the path and its permissions");
  std::ofstream out(into, std::ios::binary | std::ios::trunc);
  std::vector<char> block(kPieceBytes);
  int got = 1;
  while (out && got > 0) {
    got = gzread(in.get(), block.data(), static_cast<unsigned>(block.size()));
    if (got > 0) out.write(block.data(), got);
  }
  int fault = Z_OK;
  gzerror(in.get(), &fault);
  const bool is_cut_off = fault == Z_BUF_ERROR;
  if (fault != Z_OK && fault != Z_STREAM_END && !is_cut_off) {
    return Refuse(file.string(), "cannot be decompressed as gzip", "copy the file again");
  }
  out.close();
  if (!out) {
    return Refuse(into.string(), "cannot be written while " + file.string() + " is decompressed",
                  "make room there, or name another folder by TMPDIR");
  }
  return !is_cut_off;
}

}  // namespace telltale
