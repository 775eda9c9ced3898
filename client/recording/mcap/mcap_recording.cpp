#include "telltale/client/recording/mcap/mcap_recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/lz4_frame.hpp"
#include "telltale/client/recording/mavlink/mavlink_json.hpp"
#include "telltale/client/recording/mavlink/mavlink_recording.hpp"
#include "telltale/client/recording/ros/idl_definition.hpp"
#include "telltale/client/recording/ros/ros_intake.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace telltale {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kRecordHeader = 9;                          // opcode and length
constexpr std::uint64_t kLargestChunk = std::uint64_t{64} << 20;  // writers make chunks of some MB

enum Opcode : std::uint8_t { kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6, kDataEnd = 15 };

std::string_view TextOf(Bytes raw) {
  return {reinterpret_cast<const char*>(raw.data()), raw.size()};
}

/// Fields of a record in order; a field beyond the end makes Ok() false.
class Fields {
 public:
  explicit Fields(Bytes bytes) : bytes_(bytes) {}

  template <class Number>
  Number Read() {
    Number value{};
    const Bytes raw = Take(sizeof(Number));
    for (std::size_t i = raw.size(); i > 0; --i) {
      value = static_cast<Number>(static_cast<std::uint64_t>(value) << 8 | raw[i - 1]);
    }
    return value;
  }
  std::string_view Text() { return TextOf(Take(Read<std::uint32_t>())); }
  Bytes Take(std::uint64_t length) {
    ok_ = ok_ && length <= bytes_.size();
    if (!ok_) return {};
    const Bytes taken = bytes_.first(static_cast<std::size_t>(length));
    bytes_ = bytes_.subspan(static_cast<std::size_t>(length));
    return taken;
  }
  Bytes Rest() { return ok_ ? bytes_ : Bytes{}; }
  bool Ok() const { return ok_; }

 private:
  Bytes bytes_;
  bool ok_ = true;
};

class McapFile {
 public:
  explicit McapFile(const std::function<void(const McapMessage&)>& visit) : visit_(visit) {}

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
      if (rest.size() < kRecordHeader) return at_end ? at + Cut(rest.size()) : at;
      Fields header(rest);
      const auto opcode = header.Read<std::uint8_t>();
      const auto length = header.Read<std::uint64_t>();
      if (length > rest.size() - kRecordHeader) {
        if (IsOfUse(opcode) && length <= 2 * kLargestChunk) {
          if (!at_end) return at;
          if (opcode == kChunk) TakeCutChunk(rest.subspan(kRecordHeader));
          return at + Cut(rest.size());
        }
        // An attachment, say, need not be held in memory.
        damage_.overlong_records += IsOfUse(opcode) ? 1 : 0;
        passing_over_ = length;
        passed_over_ = kRecordHeader;
        at += kRecordHeader;
        continue;
      }
      TakeRecord(opcode, rest.subspan(kRecordHeader, static_cast<std::size_t>(length)));
      at += kRecordHeader + static_cast<std::size_t>(length);
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
    std::uint16_t schema = 0;
    std::string topic;
    std::string encoding;
  };

  std::size_t Cut(std::size_t bytes) {
    damage_.truncated_bytes += bytes;
    return bytes;
  }

  static bool IsOfUse(std::uint8_t opcode) {
    return opcode == kSchema || opcode == kChannel || opcode == kMessage || opcode == kChunk ||
           opcode == kDataEnd;
  }

  void TakeRecord(std::uint8_t opcode, Bytes content) {
    switch (opcode) {
      case kSchema: TakeSchema(Fields(content)); break;
      case kChannel: TakeChannel(Fields(content)); break;
      case kMessage: TakeMessage(Fields(content)); break;
      case kChunk: TakeChunk(Fields(content)); break;
      case kDataEnd: is_ended_ = true; break;  // what follows repeats schemas and indexes
      default: break;
    }
  }

  void TakeSchema(Fields fields) {
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

  void TakeChannel(Fields fields) {
    const auto id = fields.Read<std::uint16_t>();
    Channel channel;
    channel.schema = fields.Read<std::uint16_t>();
    channel.topic = std::string(fields.Text());
    channel.encoding = std::string(fields.Text());
    if (fields.Ok()) channels_[id] = std::move(channel);
  }

  void TakeMessage(Fields fields) {
    const auto id = fields.Read<std::uint16_t>();
    fields.Read<std::uint32_t>();  // sequence number
    const auto log_time_ns = static_cast<std::int64_t>(fields.Read<std::uint64_t>());
    fields.Read<std::uint64_t>();  // time of publication
    if (!fields.Ok()) return;
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) {
      ++damage_.unknown_channels;
      return;
    }
    static const Schema none;
    const auto found = schemas_.find(channel->second.schema);
    const Schema& schema = found == schemas_.end() ? none : found->second;
    ++damage_.messages;
    visit_({channel->second.topic, schema.name, channel->second.encoding, log_time_ns,
            fields.Rest(), schema.definition});
  }

  void TakeChunk(Fields fields) {
    fields.Read<std::uint64_t>();  // first and last time
    fields.Read<std::uint64_t>();
    const auto size = fields.Read<std::uint64_t>();
    fields.Read<std::uint32_t>();  // checksum
    const std::string_view compression = fields.Text();
    const Bytes records = fields.Take(fields.Read<std::uint64_t>());
    if (!fields.Ok() || size > kLargestChunk) {
      ++damage_.unreadable_chunks;
      return;
    }
    if (compression.empty()) return TakeRecords(records);
    chunk_.resize(static_cast<std::size_t>(size));
    const bool is_whole = compression == "zstd"  ? InflateZstdFrame(records, chunk_)
                          : compression == "lz4" ? InflateLz4Frame(records, chunk_)
                                                 : false;
    if (is_whole) {
      TakeRecords(chunk_);
    } else {
      ++damage_.unreadable_chunks;
    }
  }

  /// A chunk that the end of the file cuts off still gives its whole records where it is not
  /// compressed.
  void TakeCutChunk(Bytes content) {
    Fields fields(content);
    for (int i = 0; i < 3; ++i) fields.Read<std::uint64_t>();
    fields.Read<std::uint32_t>();
    const std::string_view compression = fields.Text();
    fields.Read<std::uint64_t>();
    if (fields.Ok() && compression.empty()) TakeRecords(fields.Rest());
  }

  void TakeRecords(Bytes records) {
    while (records.size() >= kRecordHeader) {
      Fields header(records);
      const auto opcode = header.Read<std::uint8_t>();
      const auto length = header.Read<std::uint64_t>();
      if (length > records.size() - kRecordHeader) return;
      if (opcode != kChunk) {
        TakeRecord(opcode, records.subspan(kRecordHeader, static_cast<std::size_t>(length)));
      }
      records = records.subspan(kRecordHeader + static_cast<std::size_t>(length));
    }
  }

  const std::function<void(const McapMessage&)>& visit_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<std::uint8_t> chunk_;
  McapDamage damage_;
  std::uint64_t passing_over_ = 0;  ///< bytes of a record of no use that are still to come
  std::uint64_t passed_over_ = 0;   ///< and those that have come
  bool has_magic_ = false;
  bool is_foreign_ = false;
  bool is_ended_ = false;
};

}  // namespace

bool BeginsLikeMcap(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kMcapMagic.size() && TextOf(bytes.first(kMcapMagic.size())) == kMcapMagic;
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
  return out.str();
}

namespace {

/// What the messages of one file say; which of ROS 2 and BlueOS counts, the most messages say.
class McapRecording {
 public:
  explicit McapRecording(const SourceOptions& options) : options_(options), ros_(options) {}

  void Take(const McapMessage& message) {
    if (message.encoding == "cdr") {
      ++of_ros_;
      ros_.Take(message.topic, message.schema, message.definition, message.log_time_ns,
                message.data);
    } else if (message.encoding == "ros1") {
      ++of_ros_;
      ros_.Take(message.topic, TypeOfRos2(message.schema), message.definition, message.log_time_ns,
                message.data, CdrReader::Encoding::kRos1);
    } else if (message.encoding == "json" && ros_.Mapped() != nullptr) {
      ros_.Mapped()->TakeJson(message.topic, message.log_time_ns, message.data);
    } else if (message.encoding == "json" &&
               message.topic.find("mavlink/") != std::string_view::npos) {
      ++of_mavlink_;
      const std::string_view type = message.topic.substr(message.topic.rfind('/') + 1);
      if (IsMavlinkMessageOfUse(type) && !json_.Take(message.data, mavlink_)) ++unreadable_;
    }
  }

  SourceLog Finish(const McapDamage& damage) && {
    SourceLog log = of_mavlink_ > of_ros_ ? std::move(mavlink_).Finish(options_) : ros_.Finish();
    if (unreadable_ > 0) log.summary += "; " + std::to_string(unreadable_) + " unreadable messages";
    log.summary += damage.Summary();
    return log;
  }

 private:
  const SourceOptions& options_;
  RosIntake ros_;
  MavlinkRecording mavlink_;
  MavlinkJson json_;
  std::uint64_t of_ros_ = 0;
  std::uint64_t of_mavlink_ = 0;
  std::uint64_t unreadable_ = 0;
};

}  // namespace

Result<McapDamage> ForEachMcapMessage(const std::filesystem::path& file,
                                      const std::function<void(const McapMessage&)>& visit) {
  McapFile mcap(visit);
  const auto read =
      ReadInBlocks(file, [&](Bytes bytes, bool at_end) { return mcap.Consume(bytes, at_end); });
  if (!read) return tl::unexpected(read.error());
  if (mcap.IsForeign()) {
    return Refuse(file.string(), "is not an MCAP file",
                  "give a file that begins with MCAP's magic");
  }
  return mcap.Damage();
}

SourceLog ParseMcap(std::span<const std::uint8_t> bytes, std::size_t block,
                    const SourceOptions& options) {
  McapRecording recording(options);
  const std::function<void(const McapMessage&)> take = [&](const McapMessage& message) {
    recording.Take(message);
  };
  McapFile mcap(take);
  TakeInBlocks(bytes, block, [&](Bytes part, bool at_end) { return mcap.Consume(part, at_end); });
  return std::move(recording).Finish(mcap.Damage());
}

Result<SourceLog> ReadMcap(const std::filesystem::path& file, const SourceOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  McapRecording recording(options);
  const auto damage =
      ForEachMcapMessage(file, [&](const McapMessage& message) { recording.Take(message); });
  if (!damage) return tl::unexpected(damage.error());
  SourceLog log = std::move(recording).Finish(*damage);
  return Complete(std::move(log), file);
}

}  // namespace telltale
