#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "insist.hpp"
#include "memory_file.hpp"
#include "telltale/client/recording/gzip_file.hpp"
#include "telltale/client/recording/temporary_file.hpp"

/// What is refused says why, and no byte makes more than deflate can.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using telltale::Insist;
  constexpr std::size_t kMostOfAByte = 1032;  // RFC 1951: 258 bytes of two bits
  const telltale::MemoryFile file({data, size});
  // What is inflated into a file in memory finds no room beside it.
  static const telltale::TemporaryFile inflated;
  const auto whole = telltale::InflateGzipFile(file.Path(), inflated.Path());
  Insist(whole || !whole.error().reason.empty());
  Insist(std::filesystem::file_size(inflated.Path()) <= kMostOfAByte * size);
  return 0;
}
