#include "telltale/service/storage/packed_blob.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include <zstd.h>

#include "telltale/client/recording/zstd_frame.hpp"
#include "telltale/idl/codec/checksum.hpp"

namespace telltale {
namespace {

constexpr int kCompressionLevel = 3;
constexpr std::size_t kChecksumBytes = sizeof(std::uint32_t);
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

std::array<char, kChecksumBytes> ChecksumBytes(std::string_view bytes) {
  const std::uint32_t sum = ChecksumOf(bytes);
  std::array<char, kChecksumBytes> text{};
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(sum >> (8 * i));
  return text;
}

}  // namespace

std::string PackBlob(std::string_view bytes) {
  std::string blob(kChecksumBytes + ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(blob.data() + kChecksumBytes, blob.size() - kChecksumBytes,
                                         bytes.data(), bytes.size(), kCompressionLevel);
  blob.resize(kChecksumBytes + size);
  const auto checksum = ChecksumBytes(std::string_view(blob).substr(kChecksumBytes));
  std::memcpy(blob.data(), checksum.data(), checksum.size());
  return blob;
}

std::optional<std::string> UnpackBlob(std::string_view blob) {
  if (blob.size() < kChecksumBytes) return std::nullopt;
  const std::string_view packed = blob.substr(kChecksumBytes);
  const auto checksum = ChecksumBytes(packed);
  if (std::memcmp(checksum.data(), blob.data(), checksum.size()) != 0) return std::nullopt;
  const auto* const frame = reinterpret_cast<const std::uint8_t*>(packed.data());
  std::vector<std::uint8_t> bytes;
  if (!ZstdInflater().InflateOfItsLength({frame, packed.size()}, kMostBytes, bytes)) {
    return std::nullopt;
  }
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace telltale
