#include "telltale/client/recording/mcap/mcap_recording.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include <lz4frame.h>
#include <zstd.h>
#include <nlohmann/json.hpp>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/mavlink/mavlink_recording.hpp"
#include "telltale/client/recording/ros/ros_recording.hpp"

namespace telltale {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kRecordHeader = 9;  // opcode and length
constexpr std::uint64_t kLargestChunk = std::uint64_t{256} << 20;

enum Opcode : std::uint8_t { kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6, kDataEnd = 15 };

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
  std::string_view Text() {
    const Bytes raw = Take(Read<std::uint32_t>());
    return {reinterpret_cast<const char*>(raw.data()), raw.size()};
  }
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

bool InflateZstd(Bytes compressed, std::vector<std::uint8_t>& out) {
  const std::size_t size =
      ZSTD_decompress(out.data(), out.size(), compressed.data(), compressed.size());
  return ZSTD_isError(size) == 0 && size == out.size();
}

bool InflateLz4(Bytes compressed, std::vector<std::uint8_t>& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return false;
  std::size_t from = 0;
  std::size_t to = 0;
  bool is_done = false;
  while (!is_done && from < compressed.size()) {
    std::size_t taken = compressed.size() - from;
    std::size_t given = out.size() - to;
    const std::size_t hint = LZ4F_decompress(context, out.data() + to, &given,
                                             compressed.data() + from, &taken, nullptr);
    if (LZ4F_isError(hint) != 0 || (taken == 0 && given == 0)) break;
    from += taken;
    to += given;
    is_done = hint == 0;
  }
  LZ4F_freeDecompressionContext(context);
  return is_done && to == out.size();
}

class McapFile {
 public:
  explicit McapFile(const std::function<void(const McapMessage&)>& visit) : visit_(visit) {}

  /// Returns how many bytes of whole records there are.
  std::size_t Consume(Bytes bytes, bool at_end) {
    std::size_t at = 0;
    if (!has_magic_) {
      if (bytes.size() < kMagic.size()) return at_end ? Cut(bytes.size()) : 0;
      if (!std::equal(kMagic.begin(), kMagic.end(), bytes.begin())) {
        is_foreign_ = true;
        return bytes.size();
      }
      has_magic_ = true;
      at = kMagic.size();
    }
    while (at < bytes.size() && !is_foreign_ && !is_ended_) {
      const Bytes rest = bytes.subspan(at);
      if (rest.size() < kRecordHeader) return at_end ? at + Cut(rest.size()) : at;
      Fields header(rest);
      const auto opcode = header.Read<std::uint8_t>();
      const auto length = header.Read<std::uint64_t>();
      if (length > rest.size() - kRecordHeader) {
        if (!at_end) return at;
        if (opcode == kChunk) TakeCutChunk(rest.subspan(kRecordHeader));
        return at + Cut(rest.size());
      }
      TakeRecord(opcode, rest.subspan(kRecordHeader, static_cast<std::size_t>(length)));
      at += kRecordHeader + static_cast<std::size_t>(length);
    }
    return bytes.size();
  }

  bool IsForeign() const { return is_foreign_ || !has_magic_; }
  const McapDamage& Damage() const { return damage_; }

 private:
  struct Channel {
    std::uint16_t schema = 0;
    std::string topic;
    std::string encoding;
  };

  std::size_t Cut(std::size_t bytes) {
    damage_.truncated_bytes += bytes;
    return bytes;
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
    if (fields.Ok()) schemas_[id] = std::string(name);
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
    const auto schema = schemas_.find(channel->second.schema);
    ++damage_.messages;
    visit_({channel->second.topic,
            schema == schemas_.end() ? std::string_view() : std::string_view(schema->second),
            channel->second.encoding, log_time_ns, fields.Rest()});
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
    const bool is_whole = compression == "zstd"  ? InflateZstd(records, chunk_)
                          : compression == "lz4" ? InflateLz4(records, chunk_)
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
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<std::uint8_t> chunk_;
  McapDamage damage_;
  bool has_magic_ = false;
  bool is_foreign_ = false;
  bool is_ended_ = false;
};

using Json = nlohmann::json;

std::string ParameterNameOf(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  std::string name;
  if (value.is_array()) {
    for (const Json& item : value) {
      if (item.is_string()) name += item.get<std::string>();
    }
  }
  while (!name.empty() && name.back() == '\0') name.pop_back();
  return name;
}

std::uint8_t FixTypeOf(const Json& value) {
  if (value.is_number()) return value.get<std::uint8_t>();
  const Json& type = value.is_object() && value.contains("type") ? value.at("type") : value;
  const std::string name = type.is_string() ? type.get<std::string>() : "";
  const bool has_none = name.empty() || name == "GPS_FIX_TYPE_NO_GPS" ||
                        name == "GPS_FIX_TYPE_NO_FIX" || name == "GPS_FIX_TYPE_2D_FIX";
  return has_none ? 0 : 3;
}

/// A MAVLink message as the BlueOS recorder writes it:
/// {"header": {"system_id": 1, ...}, "message": {"type": "ATTITUDE", "time_boot_ms": ..., ...}}.
bool TakeJson(Bytes data, MavlinkRecording& recording) {
  const Json root = Json::parse(data.begin(), data.end(), nullptr, false);
  if (!root.is_object() || !root.contains("message") || !root.contains("header")) return false;
  try {
    const int system = root.at("header").at("system_id").get<int>();
    const Json& message = root.at("message");
    const std::string type = message.at("type").get<std::string>();
    if (type == "GPS_RAW_INT") {
      recording.Take(system, MavlinkGpsRawInt{message.at("time_usec").get<std::uint64_t>(),
                                              1e-7 * message.at("lat").get<double>(),
                                              1e-7 * message.at("lon").get<double>(),
                                              FixTypeOf(message.at("fix_type"))});
    } else if (type == "GLOBAL_POSITION_INT") {
      MavlinkGlobalPositionInt position{message.at("time_boot_ms").get<std::uint32_t>(),
                                        1e-7 * message.at("lat").get<double>(),
                                        1e-7 * message.at("lon").get<double>(), std::nullopt};
      const double heading = message.at("hdg").get<double>();
      if (heading < 36000.5) position.heading_deg = 0.01 * heading;
      recording.Take(system, position);
    } else if (type == "ATTITUDE") {
      recording.Take(system, MavlinkAttitude{message.at("time_boot_ms").get<std::uint32_t>(),
                                             message.at("yaw").get<float>()});
    } else if (type == "SERVO_OUTPUT_RAW") {
      MavlinkServoOutputRaw output;
      output.time_us = message.at("time_usec").get<std::uint32_t>();
      output.bank = message.value("port", std::uint8_t{0});
      for (std::size_t i = 0; i < output.pulse_us.size(); ++i) {
        output.pulse_us[i] =
            message.value("servo" + std::to_string(i + 1) + "_raw", std::uint16_t{0});
      }
      recording.Take(system, output);
    } else if (type == "PARAM_VALUE") {
      recording.Take(system, MavlinkParamValue{ParameterNameOf(message.at("param_id")),
                                               message.at("param_value").get<float>()});
    } else if (type == "SYSTEM_TIME") {
      recording.Take(system, MavlinkSystemTime{message.at("time_unix_usec").get<std::uint64_t>(),
                                               message.at("time_boot_ms").get<std::uint32_t>()});
    }
  } catch (const Json::exception&) {
    return false;
  }
  return true;
}

}  // namespace

std::string McapDamage::Summary() const {
  std::ostringstream out;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) out << "; " << count << ' ' << what;
  };
  add(unreadable_chunks, "unreadable chunks");
  add(unknown_channels, "messages of undefined channels");
  add(truncated_bytes, "bytes of a record cut off at the end");
  return out.str();
}

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

Result<SourceLog> ReadMcap(const std::filesystem::path& file, const SourceOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  RosRecording ros;
  MavlinkRecording mavlink;
  std::uint64_t of_ros = 0;
  std::uint64_t of_mavlink = 0;
  std::uint64_t unreadable = 0;
  const auto damage = ForEachMcapMessage(file, [&](const McapMessage& message) {
    if (message.encoding == "cdr") {
      ++of_ros;
      ros.Take(message.topic, message.schema, message.log_time_ns, message.data);
    } else if (message.encoding == "json" &&
               message.topic.find("mavlink/") != std::string_view::npos) {
      ++of_mavlink;
      if (!TakeJson(message.data, mavlink)) ++unreadable;
    }
  });
  if (!damage) return tl::unexpected(damage.error());
  SourceLog log = of_mavlink > of_ros ? mavlink.Finish(options) : ros.Finish(options);
  if (unreadable > 0) log.summary += "; " + std::to_string(unreadable) + " unreadable messages";
  log.summary += damage->Summary();
  if (auto refusal = log.Lacks()) {
    refusal->subject = file.string() + " " + refusal->subject;
    return tl::unexpected(*std::move(refusal));
  }
  return log;
}

}  // namespace telltale
