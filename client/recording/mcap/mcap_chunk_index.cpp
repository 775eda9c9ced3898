#include "telltale/client/recording/mcap/mcap_chunk_index.hpp"

#include <algorithm>

#include "telltale/client/recording/mcap/mcap_records.hpp"

namespace telltale {
namespace {

constexpr std::size_t kEntryBytes = 16;

template <class Visit>
void ForEachOffset(std::span<const std::uint8_t> entries, Visit visit) {
  for (; entries.size() >= kEntryBytes; entries = entries.subspan(kEntryBytes)) {
    visit(McapFields(entries.subspan(kEntryBytes / 2)).Read<std::uint64_t>());
  }
}

}  // namespace

McapChunkIndex::Outcome McapChunkIndex::Read(std::span<const std::uint8_t> behind) {
  channels_.clear();
  McapRecords records(behind);
  while (!records.Rest().empty() && records.Rest()[0] == McapOpcode::kMessageIndex) {
    McapRecords::Record record;
    if (!records.Next(record)) return Outcome::kIncomplete;
    McapFields fields(record.content);
    Channel channel;
    channel.id = fields.Read<std::uint16_t>();
    channel.entries = fields.Take(fields.Read<std::uint32_t>());
    channels_.push_back(channel);
  }
  return records.Rest().empty() ? Outcome::kIncomplete : Outcome::kWhole;
}

std::uint64_t McapChunkIndex::BytesOfUse(
    std::uint64_t size,
    const std::function<std::optional<bool>(std::uint16_t channel)>& is_of_use) const {
  if (channels_.empty()) return size;
  std::optional<std::uint64_t> last;
  bool all_are_of_use = true;
  for (const Channel& channel : channels_) {
    const auto of_use = is_of_use(channel.id);
    if (!of_use) return size;
    all_are_of_use = all_are_of_use && *of_use;
    if (!*of_use) continue;
    ForEachOffset(channel.entries,
                  [&](std::uint64_t offset) { last = std::max(last.value_or(offset), offset); });
  }
  if (all_are_of_use) return size;
  if (!last) return 0;
  // The last message of use ends where the next of any channel begins.
  std::uint64_t end = size;
  for (const Channel& channel : channels_) {
    ForEachOffset(channel.entries, [&](std::uint64_t offset) {
      if (offset > *last) end = std::min(end, offset);
    });
  }
  return end;
}

}  // namespace telltale
