#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "insist.hpp"
#include "memory_file.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace {

constexpr std::size_t kMost = std::size_t{1} << 24;

/// A file is never inflated to more than it may, and what is refused says why.
void InflateFile(std::span<const std::uint8_t> bytes) {
  const telltale::MemoryFile file(bytes);
  const telltale::MemoryFile inflated({});
  const auto whole = telltale::InflateZstdFile(file.Path(), inflated.Path(), kMost);
  telltale::Insist(whole || !whole.error().reason.empty());
  telltale::Insist(inflated.Size() <= kMost);
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
