#include "telltale/client/exchange/mcap_writer.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <stdexcept>

#include <zstd.h>

#include "telltale/client/recording/mcap/mcap_records.hpp"
#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr std::string_view kCompression = "zstd";
constexpr std::uint32_t kNoChecksum = 0;  // the format's word for "not computed"

/// The content of a record, field by field.
class Content {
 public:
  template <class Number>
  Content& Put(Number value) {
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF));
    }
    return *this;
  }
  Content& Text(std::string_view text) {
    return Put(static_cast<std::uint32_t>(text.size())).Raw(text);
  }
  Content& Raw(std::string_view bytes) {
    bytes_.append(bytes);
    return *this;
  }
  std::string As(std::uint8_t opcode) const {
    Content whole;
    whole.Put(opcode).Put(std::uint64_t{bytes_.size()}).Raw(bytes_);
    return whole.bytes_;
  }
  const std::string& Bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Numbers by channel, as a map field.
Content ChannelMap(const std::map<std::uint16_t, std::uint64_t>& numbers) {
  Content map;
  for (const auto& [channel, number] : numbers) map.Put(channel).Put(number);
  return map;
}

std::string Compressed(std::string_view bytes) {
  std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), 3);
  if (ZSTD_isError(size) != 0) throw std::runtime_error("zstd cannot compress a chunk");
  compressed.resize(size);
  return compressed;
}

/// Records of one chunk, and where the messages of each channel begin in it.
struct Chunk {
  std::string records;
  std::uint64_t start_ns = 0;
  std::uint64_t end_ns = 0;
  std::map<std::uint16_t, Content> index;

  void AppendTo(std::string& file, std::string& summary) const {
    const std::string compressed = Compressed(records);
    const std::uint64_t chunk_at = file.size();
    file += Content()
                .Put(start_ns)
                .Put(end_ns)
                .Put(std::uint64_t{records.size()})
                .Put(kNoChecksum)
                .Text(kCompression)
                .Put(std::uint64_t{compressed.size()})
                .Raw(compressed)
                .As(McapOpcode::kChunk);
    const std::uint64_t chunk_bytes = file.size() - chunk_at;
    std::map<std::uint16_t, std::uint64_t> index_at;
    for (const auto& [channel, entries] : index) {
      index_at[channel] = file.size();
      file += Content().Put(channel).Text(entries.Bytes()).As(McapOpcode::kMessageIndex);
    }
    summary += Content()
                   .Put(start_ns)
                   .Put(end_ns)
                   .Put(chunk_at)
                   .Put(chunk_bytes)
                   .Text(ChannelMap(index_at).Bytes())
                   .Put(std::uint64_t{file.size() - chunk_at - chunk_bytes})
                   .Text(kCompression)
                   .Put(std::uint64_t{compressed.size()})
                   .Put(std::uint64_t{records.size()})
                   .As(McapOpcode::kChunkIndex);
  }
};

}  // namespace

std::uint16_t McapWriter::AddChannel(const std::string& topic, const std::string& schema_name,
                                     const std::string& json_schema) {
  channels_.push_back({topic, schema_name, json_schema});
  return static_cast<std::uint16_t>(channels_.size());  // schema 0 means none, so from 1
}

void McapWriter::Add(std::uint16_t channel, std::int64_t time_ns, std::string json) {
  Require(1 <= channel && channel <= channels_.size(), "a channel that was added");
  Require(time_ns >= 0, "a time after 1970");
  messages_.push_back({channel, static_cast<std::uint64_t>(time_ns), std::move(json)});
}

std::string McapWriter::Definitions() const {
  std::string records;
  std::uint16_t number = 0;
  for (const Channel& channel : channels_) {
    ++number;
    records += Content()
                   .Put(number)
                   .Text(channel.schema_name)
                   .Text("jsonschema")
                   .Text(channel.json_schema)
                   .As(McapOpcode::kSchema);
    records += Content()
                   .Put(number)
                   .Put(number)
                   .Text(channel.topic)
                   .Text("json")
                   .Text("")
                   .As(McapOpcode::kChannel);
  }
  return records;
}

std::string McapWriter::Finish() const {
  std::vector<const Message*> in_order;
  for (const Message& message : messages_) in_order.push_back(&message);
  std::stable_sort(in_order.begin(), in_order.end(),
                   [](const Message* a, const Message* b) { return a->time_ns < b->time_ns; });

  std::string file(kMcapMagic);
  file += Content().Text("").Text("telltale").As(McapOpcode::kHeader);
  std::string chunk_indexes;
  std::uint32_t chunks = 0;
  std::map<std::uint16_t, std::uint64_t> counts;
  Chunk chunk;
  chunk.records = Definitions();
  const auto close_chunk = [&] {
    chunk.AppendTo(file, chunk_indexes);
    ++chunks;
    chunk = {};
  };
  for (const Message* message : in_order) {
    if (chunk.index.empty()) chunk.start_ns = message->time_ns;
    chunk.end_ns = message->time_ns;
    chunk.index[message->channel].Put(message->time_ns).Put(std::uint64_t{chunk.records.size()});
    const auto sequence = static_cast<std::uint32_t>(counts[message->channel]++);
    chunk.records += Content()
                         .Put(message->channel)
                         .Put(sequence)
                         .Put(message->time_ns)
                         .Put(message->time_ns)
                         .Raw(message->json)
                         .As(McapOpcode::kMessage);
    if (chunk.records.size() >= kChunkBytes) close_chunk();
  }
  if (!chunk.records.empty()) close_chunk();
  file += Content().Put(kNoChecksum).As(McapOpcode::kDataEnd);

  const std::uint64_t summary_at = file.size();
  file += Definitions();
  file += Content()
              .Put(std::uint64_t{messages_.size()})
              .Put(static_cast<std::uint16_t>(channels_.size()))
              .Put(static_cast<std::uint32_t>(channels_.size()))
              .Put(std::uint32_t{0})  // attachments
              .Put(std::uint32_t{0})  // metadata
              .Put(chunks)
              .Put(in_order.empty() ? std::uint64_t{0} : in_order.front()->time_ns)
              .Put(in_order.empty() ? std::uint64_t{0} : in_order.back()->time_ns)
              .Text(ChannelMap(counts).Bytes())
              .As(McapOpcode::kStatistics);
  file += chunk_indexes;
  file += Content().Put(summary_at).Put(std::uint64_t{0}).Put(kNoChecksum).As(McapOpcode::kFooter);
  return file.append(kMcapMagic);
}

}  // namespace telltale
