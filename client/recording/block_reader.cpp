#include "telltale/client/recording/block_reader.hpp"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <vector>

namespace telltale {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
constexpr std::size_t kLongestItem = std::size_t{256} << 20;

}  // namespace

Result<std::uint64_t> ReadInBlocks(const std::filesystem::path& file, const BlockConsumer& consume,
                                   const ReadProgress& progress) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return Refuse(file.string(), "cannot be opened", "check the path and its permissions");
  std::error_code ignored;
  const auto size = static_cast<double>(std::filesystem::file_size(file, ignored));
  std::vector<std::uint8_t> block(kBlockBytes);
  std::size_t filled = 0;
  std::uint64_t total = 0;
  for (bool at_end = false; !at_end;) {
    if (filled == block.size()) {
      if (block.size() >= kLongestItem) {
        return Refuse(file.string(), "holds an item of more than 256 MB", "check the file");
      }
      block.resize(2 * block.size());
    }
    in.read(reinterpret_cast<char*>(block.data() + filled),
            static_cast<std::streamsize>(block.size() - filled));
    const auto got = static_cast<std::size_t>(in.gcount());
    if (in.bad()) return Refuse(file.string(), "cannot be read", "check the disk");
    at_end = !in;
    total += got;
    filled += got;
    const std::size_t done = consume({block.data(), filled}, at_end);
    std::copy(block.begin() + static_cast<std::ptrdiff_t>(done),
              block.begin() + static_cast<std::ptrdiff_t>(filled), block.begin());
    filled -= done;
    if (progress) progress(static_cast<double>(total) / size);
  }
  malloc_trim(0);  // what the samples' vectors left behind as they grew
  return total;
}

}  // namespace telltale
