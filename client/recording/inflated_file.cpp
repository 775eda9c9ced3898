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

std::string MoreThan(std::uint64_t bytes) {
  return "inflates to more than " + Gigabytes(bytes);
}

}  // namespace

Refusal TooMuchInflated(const std::filesystem::path& compressed, std::uint64_t most_bytes) {
  return {compressed.string(), MoreThan(most_bytes), "check what it is, or decompress it"};
}

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
    if (!is_bound_by_disk_) return TooMuchInflated(compressed_, most_bytes_);
    return Refusal{
        compressed_,
        MoreThan(most_bytes_) + ", nine tenths of what is free in " + path_.parent_path().string(),
        "make room there, or name another folder by TMPDIR"};
  }
  if (out_) return std::nullopt;
  return Refusal{path_.string(), "cannot be written while " + compressed_ + " is decompressed",
                 "make room there, or name another folder by TMPDIR"};
}

}  // namespace telltale
