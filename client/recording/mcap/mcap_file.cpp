#include "telltale/client/recording/mcap/mcap_file.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

#include <libdeflate.h>

#include "telltale/client/recording/lz4_frame.hpp"
#include "telltale/client/recording/mcap/mcap_chunk_index.hpp"
#include "telltale/client/recording/mcap/mcap_summary.hpp"
#include "telltale/client/recording/ros/idl_definition.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace telltale {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kLargestChunk = std::uint64_t{64} << 20;  // writers make chunks of some MB
constexpr std::size_t kLargestIndex = std::size_t{16} << 20;      // of a chunk

class McapFile {
 public:
  explicit McapFile(const McapVisitor& visitor) : visitor_(visitor) {}

  /// What the summary defines, which lets chunks be passed over. `summary`: the file from there on;
  /// empty: it has none.
  void TakeSummary(Bytes summary) {
    if (!IsSoundMcapSummary(summary)) return;
    std::optional<std::uint32_t> stated_channels;
    McapRecords records(summary);
    for (McapRecords::Record record; records.Next(record);) {
      if (record.opcode == McapOpcode::kSchema || record.opcode == McapOpcode::kChannel) {
        TakeRecord(record);
      } else if (record.opcode == McapOpcode::kStatistics) {
        McapFields fields(record.content);
        fields.Read<std::uint64_t>();  // messages
        fields.Read<std::uint16_t>();  // schemas
        stated_channels = fields.Read<std::uint32_t>();
      }
    }
    defines_all_channels_ = stated_channels == defined_channels_;
  }

  /// Returns how many bytes of whole records there are.
  std::size_t Consume(Bytes bytes, bool at_end) {
    if (is_foreign_) return bytes.size();
    std::size_t at = 0;
    if (!has_magic_) {
      if (bytes.size() < kMcapMagic.size()) return at_end ? Cut(bytes.size()) : 0;
      if (!BeginsLikeMcap(bytes)) {
        is_foreign_ = true;
        return bytes.size();
      }
      has_magic_ = true;
      at = kMcapMagic.size();
    }
    while (at < bytes.size() && !is_ended_) {
      if (passing_over_ > 0) {
        const std::uint64_t passed = std::min<std::uint64_t>(passing_over_, bytes.size() - at);
        passing_over_ -= passed;
        passed_over_ += passed;
        at += static_cast<std::size_t>(passed);
        continue;
      }
      const Bytes rest = bytes.subspan(at);
      if (rest.size() < kMcapRecordHeader) return at_end ? at + Cut(rest.size()) : at;
      McapFields header(rest);
      const auto opcode = header.Read<std::uint8_t>();
      const auto length = header.Read<std::uint64_t>();
      if (length > rest.size() - kMcapRecordHeader) {
        if (IsOfUse(opcode) && length <= 2 * kLargestChunk) {
          if (!at_end) return at;
          if (opcode == McapOpcode::kChunk) TakeCutChunk(rest.subspan(kMcapRecordHeader));
          return at + Cut(rest.size());
        }
        // An attachment, say, need not be held in memory.
        damage_.overlong_records += IsOfUse(opcode) ? 1 : 0;
        passing_over_ = length;
        passed_over_ = kMcapRecordHeader;
        at += kMcapRecordHeader;
        continue;
      }
      const std::size_t end = kMcapRecordHeader + static_cast<std::size_t>(length);
      if (opcode == McapOpcode::kChunk) {
        if (NeedsMoreOfIndex(rest.subspan(end), at_end)) return at;
        TakeChunk(rest.subspan(kMcapRecordHeader, static_cast<std::size_t>(length)));
      } else {
        TakeRecord({opcode, rest.subspan(kMcapRecordHeader, static_cast<std::size_t>(length))});
      }
      at += end;
    }
    if (at_end && passing_over_ > 0) Cut(static_cast<std::size_t>(passed_over_));
    return bytes.size();
  }

  bool IsForeign() const { return is_foreign_ || !has_magic_; }
  const McapDamage& Damage() const { return damage_; }

 private:
  struct Schema {
    std::string name;
    std::string definition;
  };
  struct Channel {
    const Schema* schema = nullptr;  ///< in schemas_; null: none
    std::string topic;
    std::string encoding;
    MessageTaker take;

    bool IsOfUse() const { return take != nullptr; }
    McapChannel Described() const {
      if (schema == nullptr) return {topic, {}, encoding, {}};
      return {topic, schema->name, encoding, schema->definition};
    }
  };

  std::size_t Cut(std::size_t bytes) {
    damage_.truncated_bytes += bytes;
    return bytes;
  }

  static bool IsOfUse(std::uint8_t opcode) {
    return opcode == McapOpcode::kSchema || opcode == McapOpcode::kChannel ||
           opcode == McapOpcode::kMessage || opcode == McapOpcode::kChunk ||
           opcode == McapOpcode::kDataEnd;
  }

  void TakeRecord(const McapRecords::Record& record) {
    const McapFields content(record.content);
    switch (record.opcode) {
      case McapOpcode::kSchema: TakeSchema(content); break;
      case McapOpcode::kChannel: TakeChannel(content); break;
      case McapOpcode::kMessage: TakeMessage(content); break;
      case McapOpcode::kDataEnd: is_ended_ = true; break;  // what follows repeats and indexes
      default: break;
    }
  }

  void TakeSchema(McapFields fields) {
    const auto id = fields.Read<std::uint16_t>();
    const std::string_view name = fields.Text();
    const std::string_view encoding = fields.Text();
    const std::string_view text = fields.Text();
    if (!fields.Ok()) return;
    const bool is_definition = encoding == "ros2msg" || encoding == "ros1msg";
    schemas_[id] = {std::string(name), encoding == "ros2idl" ? RosDefinitionOfIdl(text)
                                       : is_definition       ? std::string(text)
                                                             : std::string()};
  }

  void TakeChannel(McapFields fields) {
    const auto id = fields.Read<std::uint16_t>();
    Channel channel;
    const auto schema = schemas_.find(fields.Read<std::uint16_t>());
    if (schema != schemas_.end()) channel.schema = &schema->second;
    channel.topic = std::string(fields.Text());
    channel.encoding = std::string(fields.Text());
    if (!fields.Ok()) return;
    channel.take = visitor_.open(channel.Described());
    if (channels_.size() <= id) channels_.resize(id + std::size_t{1});
    defined_channels_ += channels_[id] ? 0 : 1;
    channels_[id] = std::move(channel);
  }

  /// Null: it is not defined.
  const Channel* ChannelOf(std::uint16_t id) const {
    return id < channels_.size() && channels_[id] ? &*channels_[id] : nullptr;
  }

  void TakeMessage(McapFields fields) {
    const auto id = fields.Read<std::uint16_t>();
    fields.Read<std::uint32_t>();  // sequence number
    const auto log_time_ns = static_cast<std::int64_t>(fields.Read<std::uint64_t>());
    fields.Read<std::uint64_t>();  // time of publication
    if (!fields.Ok()) return;
    const Channel* const channel = ChannelOf(id);
    if (channel == nullptr) {
      ++damage_.unknown_channels;
      return;
    }
    if (!channel->IsOfUse()) return;
    ++damage_.messages;
    channel->take(log_time_ns, fields.Rest());
  }

  /// Reads the index of a chunk, where it lets the chunk be passed over; true: its end is still to
  /// come.
  bool NeedsMoreOfIndex(Bytes behind, bool at_end) {
    has_index_ = false;
    if (!defines_all_channels_) return false;
    const bool is_whole = index_.Read(behind) == McapChunkIndex::Outcome::kWhole;
    if (!is_whole && !at_end && behind.size() < kLargestIndex) return true;
    has_index_ = is_whole;
    return false;
  }

  std::uint64_t BytesOfUse(std::uint64_t size) const {
    if (!has_index_) return size;
    return index_.BytesOfUse(size, [this](std::uint16_t id) -> std::optional<bool> {
      const Channel* const channel = ChannelOf(id);
      if (channel == nullptr) return std::nullopt;
      return channel->IsOfUse();
    });
  }

  void TakeChunk(Bytes content) {
    McapFields fields(content);
    fields.Read<std::uint64_t>();  // first and last time
    fields.Read<std::uint64_t>();
    const auto size = fields.Read<std::uint64_t>();
    const auto checksum = fields.Read<std::uint32_t>();
    const std::string_view compression = fields.Text();
    const Bytes stored = fields.Take(fields.Read<std::uint64_t>());
    if (!fields.Ok() || size > kLargestChunk) {
      ++damage_.unreadable_chunks;
      return;
    }
    const auto of_use = static_cast<std::size_t>(BytesOfUse(size));
    if (of_use == 0) return;
    const bool is_checked = checksum != 0 && of_use == size;
    const auto records = Inflated(compression, stored, static_cast<std::size_t>(size), of_use,
                                  is_checked ? Lz4Checksums::kSkip : Lz4Checksums::kCompare);
    if (!records ||
        (is_checked && libdeflate_crc32(0, records->data(), records->size()) != checksum)) {
      ++damage_.unreadable_chunks;
      return;
    }
    TakeRecords(*records);
  }

  /// The first `of_use` bytes of a chunk of `size`; nothing where they cannot be had.
  std::optional<Bytes> Inflated(std::string_view compression, Bytes stored, std::size_t size,
                                std::size_t of_use, Lz4Checksums of_lz4) {
    if (compression.empty()) return stored.first(std::min(of_use, stored.size()));
    const std::span<std::uint8_t> out = RoomForChunk(of_use);
    const bool is_all = of_use == size;
    bool is_there = false;
    if (compression == "zstd") {
      is_there = is_all ? zstd_.Inflate(stored, out) : zstd_.InflateStart(stored, out);
    } else if (compression == "lz4") {
      is_there = is_all ? lz4_.Inflate(stored, out, of_lz4) : lz4_.InflateStart(stored, out);
    }
    return is_there ? std::optional<Bytes>(out) : std::nullopt;
  }

  /// Not filled with zeros, nor with the chunk before.
  std::span<std::uint8_t> RoomForChunk(std::size_t bytes) {
    if (room_ < bytes) {
      chunk_.reset();
      chunk_ = std::make_unique_for_overwrite<std::uint8_t[]>(bytes);
      room_ = bytes;
    }
    return {chunk_.get(), bytes};
  }

  /// A chunk that the end of the file cuts off still gives its whole records where it is not
  /// compressed.
  void TakeCutChunk(Bytes content) {
    McapFields fields(content);
    for (int i = 0; i < 3; ++i) fields.Read<std::uint64_t>();
    fields.Read<std::uint32_t>();
    const std::string_view compression = fields.Text();
    fields.Read<std::uint64_t>();
    if (fields.Ok() && compression.empty()) TakeRecords(fields.Rest());
  }

  void TakeRecords(Bytes bytes) {
    McapRecords records(bytes);
    for (McapRecords::Record record; records.Next(record);) TakeRecord(record);
  }

  const McapVisitor& visitor_;
  std::map<std::uint16_t, Schema> schemas_;
  std::vector<std::optional<Channel>> channels_;  ///< by id: each message seeks one
  std::uint32_t defined_channels_ = 0;
  McapChunkIndex index_;  ///< of the chunk at hand
  std::unique_ptr<std::uint8_t[]> chunk_;
  std::size_t room_ = 0;  ///< of it
  ZstdInflater zstd_;
  Lz4Inflater lz4_;
  McapDamage damage_;
  std::uint64_t passing_over_ = 0;  ///< bytes of a record of no use that are still to come
  std::uint64_t passed_over_ = 0;   ///< and those that have come
  bool defines_all_channels_ = false;
  bool has_index_ = false;
  bool has_magic_ = false;
  bool is_foreign_ = false;
  bool is_ended_ = false;
};

Bytes SummaryIn(Bytes file) {
  if (file.size() < kMcapEnding) return {};
  const auto start = McapSummaryStart(file.last(kMcapEnding), file.size());
  return start ? file.subspan(static_cast<std::size_t>(*start)) : Bytes{};
}

/// Whether the file is whole: one that zstd has compressed may be cut off.
Result<bool> ReadThrough(const std::filesystem::path& file, McapFile& mcap,
                         const ReadProgress& progress) {
  const auto consume = [&](Bytes bytes, bool at_end) { return mcap.Consume(bytes, at_end); };
  if (BeginsLikeZstdFrame(BeginningOf(file))) return ReadZstdInBlocks(file, consume, progress);
  mcap.TakeSummary(ReadMcapSummary(file));
  return ReadInBlocks(file, consume, progress).map([](std::uint64_t) { return true; });
}

}  // namespace

bool HoldsMcap(Bytes beginning) {
  if (!BeginsLikeZstdFrame(beginning)) return BeginsLikeMcap(beginning);
  std::array<std::uint8_t, kMcapMagic.size()> inside{};
  return ZstdInflater().InflateStart(beginning, inside) && BeginsLikeMcap(inside);
}

std::string McapDamage::Summary() const {
  std::ostringstream out;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) out << "; " << count << ' ' << what;
  };
  add(unreadable_chunks, "unreadable chunks");
  add(overlong_records, "records of more than 128 MB");
  add(unknown_channels, "messages of undefined channels");
  add(truncated_bytes, "bytes of a record cut off at the end");
  if (is_compressed_file_cut) out << "; the compressed file is cut off";
  return out.str();
}

Result<McapDamage> ForEachMcapMessage(const std::filesystem::path& file,
                                      const McapVisitor& visitor) {
  McapFile mcap(visitor);
  const auto is_whole = ReadThrough(file, mcap, visitor.progress);
  if (!is_whole) return tl::unexpected(is_whole.error());
  if (mcap.IsForeign()) {
    return Refuse(file.string(), "is not an MCAP file",
                  "give a file that begins with MCAP's magic");
  }
  McapDamage damage = mcap.Damage();
  damage.is_compressed_file_cut = !*is_whole;
  return damage;
}

McapDamage ForEachMcapMessage(std::span<const std::uint8_t> bytes, std::size_t block,
                              const McapVisitor& visitor) {
  McapFile mcap(visitor);
  mcap.TakeSummary(SummaryIn(bytes));
  TakeInBlocks(bytes, block, [&](Bytes part, bool at_end) { return mcap.Consume(part, at_end); });
  return mcap.Damage();
}

}  // namespace telltale
