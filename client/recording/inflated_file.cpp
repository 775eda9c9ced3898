#include "telltale/client/recording/inflated_file.hpp"

#include <algorithm>
#include <system_error>

#include "telltale/core/base/format_number.hpp"

namespace telltale {
namespace {

std::uint64_t RoomBeside(const std::filesystem::path& file) {
  std::error_code error;
  const auto space = std::filesystem::space(file.parent_path(), error);
  return error ? kMostInflatedBytes : space.available - space.available / 10;
}

std::string Gigabytes(std::uint64_t bytes) {
  return FormatSignificant(static_cast<double>(bytes) * 1e-9, 3) + " GB";
}

}  // namespace

InflatedFile::InflatedFile(const std::filesystem::path& compressed,
                           const std::filesystem::path& into, std::uint64_t most_bytes)
    : compressed_(compressed.string()),
      path_(into),
      out_(into, std::ios::binary | std::ios::trunc),
      most_bytes_(std::min(most_bytes, RoomBeside(into))),
      is_bound_by_disk_(most_bytes_ < most_bytes) {}

bool InflatedFile::Write(const void* bytes, std::size_t count) {
  written_ += count;
  if (written_ > most_bytes_) return false;
  out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
  return out_.good();
}

std::optional<Refusal> InflatedFile::Close() {
  out_.close();
  if (written_ > most_bytes_) {
    const std::string most = "inflates to more than " + Gigabytes(most_bytes_);
    if (!is_bound_by_disk_) return Refusal{compressed_, most, "check what it is, or decompress it"};
    return Refusal{compressed_,
                   most + ", nine tenths of what is free in " + path_.parent_path().string(),
                   "make room there, or name another folder by TMPDIR"};
  }
  if (out_) return std::nullopt;
  return Refusal{path_.string(), "cannot be written while " + compressed_ + " is decompressed",
                 "make room there, or name another folder by TMPDIR"};
}

}  // namespace telltale
