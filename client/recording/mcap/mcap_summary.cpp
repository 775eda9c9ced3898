#include "telltale/client/recording/mcap/mcap_summary.hpp"

#include <fstream>

#include <libdeflate.h>

#include "telltale/client/recording/mcap/mcap_records.hpp"

namespace telltale {
namespace {

constexpr std::uint64_t kLongestSummary = std::uint64_t{64} << 20;
constexpr std::size_t kChecksumBytes = 4;

std::vector<std::uint8_t> BytesFrom(std::ifstream& in, std::uint64_t start, std::uint64_t count) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  in.seekg(static_cast<std::streamoff>(start));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) bytes.clear();
  return bytes;
}

}  // namespace

std::optional<std::uint64_t> McapSummaryStart(std::span<const std::uint8_t> ending,
                                              std::uint64_t file_bytes) {
  if (ending.size() != kMcapEnding || file_bytes < kMcapEnding) return std::nullopt;
  if (!BeginsLikeMcap(ending.last(kMcapMagic.size()))) return std::nullopt;
  McapRecords records(ending);
  McapRecords::Record footer;
  if (!records.Next(footer) || footer.opcode != McapOpcode::kFooter) return std::nullopt;
  const auto start = McapFields(footer.content).Read<std::uint64_t>();
  const bool is_inside = 0 < start && start <= file_bytes - kMcapEnding;
  return is_inside ? std::optional(start) : std::nullopt;
}

std::vector<std::uint8_t> ReadMcapSummary(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(in.tellg());
  if (!in || size < static_cast<std::streamoff>(kMcapEnding)) return {};
  const auto bytes = static_cast<std::uint64_t>(size);
  const auto start = McapSummaryStart(BytesFrom(in, bytes - kMcapEnding, kMcapEnding), bytes);
  if (!start || bytes - *start > kLongestSummary) return {};
  return BytesFrom(in, *start, bytes - *start);
}

bool IsSoundMcapSummary(std::span<const std::uint8_t> summary) {
  const std::size_t after = kChecksumBytes + kMcapMagic.size();
  if (summary.size() < kMcapEnding) return false;
  const auto stated = McapFields(summary.last(after)).Read<std::uint32_t>();
  return stated == 0 || stated == libdeflate_crc32(0, summary.data(), summary.size() - after);
}

}  // namespace telltale
