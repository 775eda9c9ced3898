#include "telltale/service/windows/window_chunk.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include <zstd.h>

#include "telltale/idl/codec/checksum.hpp"
#include "telltale/idl/proto/window_chunk.pb.h"

namespace telltale {
namespace {

constexpr int kCompressionLevel = 3;
constexpr std::size_t kChecksumBytes = sizeof(std::uint32_t);
constexpr unsigned long long kLargestChunk = 1ULL << 30;

std::array<char, kChecksumBytes> ChecksumBytes(std::string_view bytes) {
  const std::uint32_t sum = ChecksumOf(bytes);
  std::array<char, kChecksumBytes> text{};
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(sum >> (8 * i));
  return text;
}

proto::WindowChunk ToChunk(const Recording& recording) {
  proto::WindowChunk chunk;
  for (const GnssFix& fix : recording.gnss) {
    chunk.mutable_gnss()->add_time_s(fix.time_s);
    chunk.mutable_gnss()->add_latitude_deg(fix.latitude_deg);
    chunk.mutable_gnss()->add_longitude_deg(fix.longitude_deg);
  }
  for (const HeadingSample& sample : recording.heading) {
    chunk.mutable_heading()->add_time_s(sample.time_s);
    chunk.mutable_heading()->add_heading_deg(sample.heading_deg);
  }
  for (const ThrusterSample& sample : recording.thrusters) {
    chunk.mutable_thrusters()->add_time_s(sample.time_s);
    chunk.mutable_thrusters()->add_port_us(sample.port_us);
    chunk.mutable_thrusters()->add_starboard_us(sample.starboard_us);
  }
  return chunk;
}

/// Nothing where the lists of a channel differ in length.
std::optional<Recording> ToRecording(const proto::WindowChunk& chunk) {
  const auto& gnss = chunk.gnss();
  const auto& heading = chunk.heading();
  const auto& thrusters = chunk.thrusters();
  const bool complete = gnss.latitude_deg_size() == gnss.time_s_size() &&
                        gnss.longitude_deg_size() == gnss.time_s_size() &&
                        heading.heading_deg_size() == heading.time_s_size() &&
                        thrusters.port_us_size() == thrusters.time_s_size() &&
                        thrusters.starboard_us_size() == thrusters.time_s_size();
  if (!complete) return std::nullopt;
  Recording recording;
  for (int i = 0; i < gnss.time_s_size(); ++i) {
    recording.gnss.push_back({gnss.time_s(i), gnss.latitude_deg(i), gnss.longitude_deg(i)});
  }
  for (int i = 0; i < heading.time_s_size(); ++i) {
    recording.heading.push_back({heading.time_s(i), heading.heading_deg(i)});
  }
  for (int i = 0; i < thrusters.time_s_size(); ++i) {
    recording.thrusters.push_back(
        {thrusters.time_s(i), thrusters.port_us(i), thrusters.starboard_us(i)});
  }
  return recording;
}

}  // namespace

std::string PackChunk(const Recording& recording) {
  const std::string bytes = ToChunk(recording).SerializeAsString();
  std::string blob(kChecksumBytes + ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(blob.data() + kChecksumBytes, blob.size() - kChecksumBytes,
                                         bytes.data(), bytes.size(), kCompressionLevel);
  blob.resize(kChecksumBytes + size);
  const auto checksum = ChecksumBytes(std::string_view(blob).substr(kChecksumBytes));
  std::memcpy(blob.data(), checksum.data(), checksum.size());
  return blob;
}

std::optional<Recording> UnpackChunk(std::string_view blob) {
  if (blob.size() < kChecksumBytes) return std::nullopt;
  const std::string_view packed = blob.substr(kChecksumBytes);
  const auto checksum = ChecksumBytes(packed);
  if (std::memcmp(checksum.data(), blob.data(), checksum.size()) != 0) return std::nullopt;
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size > kLargestChunk) return std::nullopt;  // what zstd does not know is larger
  std::string bytes(size, '\0');
  const std::size_t unpacked =
      ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  proto::WindowChunk chunk;
  if (ZSTD_isError(unpacked) || !chunk.ParseFromString(bytes)) return std::nullopt;
  return ToRecording(chunk);
}

}  // namespace telltale
