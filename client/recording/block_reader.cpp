#include "telltale/client/recording/block_reader.hpp"

#include <malloc.h>

#include <fstream>
#include <system_error>

namespace telltale {
namespace {

constexpr std::size_t kBytesToTellFormat = std::size_t{64} << 10;

}  // namespace

std::vector<std::uint8_t> BeginningOf(const std::filesystem::path& file) {
  std::vector<std::uint8_t> bytes(kBytesToTellFormat);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

bool BlockBuffer::Grow() {
  if (size_ >= kLongestItem) return false;
  auto longer = std::make_unique_for_overwrite<std::uint8_t[]>(2 * size_);
  std::copy_n(bytes_.get(), filled_, longer.get());
  bytes_ = std::move(longer);
  size_ *= 2;
  return true;
}

void BlockBuffer::HandOver(std::size_t more, const BlockConsumer& consume, bool at_end) {
  filled_ += more;
  const std::size_t done = consume({bytes_.get(), filled_}, at_end);
  std::copy(bytes_.get() + done, bytes_.get() + filled_, bytes_.get());
  filled_ -= done;
}

Refusal TooLongItem(const std::filesystem::path& file) {
  return {file.string(), "holds an item of more than 256 MB", "check the file"};
}

Result<std::uint64_t> ReadInBlocks(const std::filesystem::path& file, const BlockConsumer& consume,
                                   const ReadProgress& progress) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return Refuse(file.string(), "cannot be opened", "check the path and its permissions");
  std::error_code ignored;
  const auto size = static_cast<double>(std::filesystem::file_size(file, ignored));
  BlockBuffer block;
  std::uint64_t total = 0;
  while (in) {
    if (block.IsFull() && !block.Grow()) return tl::unexpected(TooLongItem(file));
    const std::span<std::uint8_t> room = block.Room();
    in.read(reinterpret_cast<char*>(room.data()), static_cast<std::streamsize>(room.size()));
    if (in.bad()) return Refuse(file.string(), "cannot be read", "check the disk");
    const auto got = static_cast<std::size_t>(in.gcount());
    total += got;
    block.HandOver(got, consume, !in);
    if (progress) progress(static_cast<double>(total) / size);
  }
  malloc_trim(0);  // what the samples' vectors left behind as they grew
  return total;
}

}  // namespace telltale
