#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "insist.hpp"
#include "memory_file.hpp"
#include "telltale/client/recording/temporary_file.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace {

constexpr std::size_t kMost = std::size_t{1} << 24;

/// A file is never inflated to more than it may, in blocks the same, and what is refused says why.
void InflateFile(std::span<const std::uint8_t> bytes) {
  const telltale::MemoryFile file(bytes);
  // What is inflated into a file in memory finds no room beside it.
  static const telltale::TemporaryFile inflated;
  const auto whole = telltale::InflateZstdFile(file.Path(), inflated.Path(), kMost);
  telltale::Insist(whole || !whole.error().reason.empty());
  const std::uintmax_t size = std::filesystem::file_size(inflated.Path());
  telltale::Insist(size <= kMost);

  std::size_t handed_over = 0;
  const auto take = [&](std::span<const std::uint8_t> part, bool) {
    handed_over += part.size();
    return part.size();
  };
  const auto in_blocks = telltale::ReadZstdInBlocks(file.Path(), take, nullptr, kMost);
  telltale::Insist(in_blocks.has_value() == whole.has_value());
  if (whole) telltale::Insist(*in_blocks == *whole && handed_over == size);
}

/// The frames of messages and chunks, whatever length they state.
void InflateFrame(std::span<const std::uint8_t> bytes) {
  telltale::ZstdInflater inflater;
  std::vector<std::uint8_t> out;
  if (inflater.InflateOfItsLength(bytes, kMost, out)) telltale::Insist(out.size() <= kMost);
  out.resize(bytes.size());
  inflater.InflateStart(bytes, out);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  InflateFile({data, size});
  InflateFrame({data, size});
  return 0;
}
