#include "telltale/client/recording/rosbag1/rosbag1.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <bzlib.h>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/lz4_frame.hpp"
#include "telltale/client/recording/ros_intake.hpp"

namespace telltale {
namespace {

using BagBytes = std::span<const std::uint8_t>;

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kLengthBytes = 4;
constexpr std::uint32_t kLargestBagChunk = std::uint32_t{64} << 20;

enum BagOperation : std::uint8_t { kMessageData = 2, kBagChunk = 5, kConnection = 7 };

std::uint32_t LittleEndian32(BagBytes bytes) {
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
         static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

/// The fields of a record's header: name=value, each after its length.
class BagFields {
 public:
  explicit BagFields(BagBytes header) {
    while (header.size() >= kLengthBytes) {
      const std::uint32_t length = LittleEndian32(header);
      header = header.subspan(kLengthBytes);
      if (length > header.size()) return;
      const BagBytes field = header.first(length);
      const auto sign = std::find(field.begin(), field.end(), '=');
      if (sign != field.end()) {
        const auto name = static_cast<std::size_t>(sign - field.begin());
        fields_[std::string(field.begin(), sign)] = field.subspan(name + 1);
      }
      header = header.subspan(length);
    }
  }

  BagBytes Of(std::string_view name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? BagBytes{} : found->second;
  }
  std::string Text(std::string_view name) const {
    const BagBytes value = Of(name);
    return {value.begin(), value.end()};
  }
  std::optional<std::uint32_t> Number(std::string_view name) const {
    const BagBytes value = Of(name);
    if (value.size() < kLengthBytes) return std::nullopt;
    return LittleEndian32(value);
  }

 private:
  std::map<std::string, BagBytes, std::less<>> fields_;
};

bool InflateBz2(BagBytes compressed, std::vector<std::uint8_t>& out) {
  auto size = static_cast<unsigned int>(out.size());
  // The library's interface is not const; it does not write to its source.
  auto* const source =
      const_cast<char*>(reinterpret_cast<const char*>(compressed.data()));  // NOLINT
  const int result = BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(out.data()), &size, source,
                                                static_cast<unsigned int>(compressed.size()), 0, 0);
  return result == BZ_OK && size == out.size();
}

class Rosbag1File {
 public:
  explicit Rosbag1File(RosIntake& recording) : recording_(recording) {}

  /// Returns how many bytes of whole records there are.
  std::size_t Consume(BagBytes bytes, bool at_end) {
    std::size_t at = 0;
    if (is_foreign_) return bytes.size();
    if (!has_magic_) {
      if (bytes.size() < kBagMagic.size() && !at_end) return 0;
      has_magic_ = BeginsLikeRosbag1(bytes);
      is_foreign_ = !has_magic_;
      if (is_foreign_) return bytes.size();
      at = kBagMagic.size();
    }
    at += TakeRecords(bytes.subspan(at));
    if (!at_end) return at;
    truncated_bytes_ += bytes.size() - at;
    return bytes.size();
  }

  bool IsBag() const { return has_magic_; }

  std::string Summary() const {
    std::string summary;
    const auto add = [&](std::uint64_t count, const char* what) {
      if (count > 0) summary += "; " + std::to_string(count) + ' ' + what;
    };
    add(unreadable_chunks_, "unreadable chunks");
    add(unknown_connections_, "messages of undefined connections");
    add(truncated_bytes_, "bytes of a record cut off at the end");
    return summary;
  }

 private:
  std::size_t TakeRecords(BagBytes bytes) {
    std::size_t at = 0;
    while (bytes.size() - at >= kLengthBytes) {
      const BagBytes rest = bytes.subspan(at);
      const std::uint64_t header = LittleEndian32(rest);
      if (rest.size() < header + 2 * kLengthBytes) break;
      const auto data_at = static_cast<std::size_t>(header) + kLengthBytes;
      const std::uint64_t data = LittleEndian32(rest.subspan(data_at));
      if (rest.size() < data_at + kLengthBytes + data) break;
      TakeRecord(BagFields(rest.subspan(kLengthBytes, static_cast<std::size_t>(header))),
                 rest.subspan(data_at + kLengthBytes, static_cast<std::size_t>(data)));
      at += data_at + kLengthBytes + static_cast<std::size_t>(data);
    }
    return at;
  }

  void TakeRecord(const BagFields& header, BagBytes data) {
    const BagBytes operation = header.Of("op");
    if (operation.size() != 1) return;
    switch (operation[0]) {
      case kMessageData: return TakeMessage(header, data);
      case kConnection: return TakeConnection(header, data);
      case kBagChunk: return TakeChunk(header, data);
      default: return;  // what indexes the file
    }
  }

  void TakeConnection(const BagFields& header, BagBytes data) {
    const auto id = header.Number("conn");
    if (!id) return;
    const BagFields said(data);
    connections_[*id] = recording_.Open(
        {header.Text("topic"), TypeOfRos2(said.Text("type")), said.Text("message_definition")},
        CdrReader::Encoding::kRos1);
  }

  void TakeMessage(const BagFields& header, BagBytes data) {
    const auto id = header.Number("conn");
    const BagBytes time = header.Of("time");
    const auto connection = id ? connections_.find(*id) : connections_.end();
    if (connection == connections_.end() || time.size() != 2 * kLengthBytes) {
      ++unknown_connections_;
      return;
    }
    const std::int64_t received_ns = std::int64_t{LittleEndian32(time)} * 1'000'000'000 +
                                     LittleEndian32(time.subspan(kLengthBytes));
    if (connection->second) connection->second(received_ns, data);
  }

  void TakeChunk(const BagFields& header, BagBytes data) {
    if (is_in_chunk_) return;  // no writer nests them
    const std::string compression = header.Text("compression");
    const std::uint32_t size = header.Number("size").value_or(0);
    is_in_chunk_ = true;
    if (compression == "none") {
      TakeRecords(data);
    } else if (size > kLargestBagChunk) {
      ++unreadable_chunks_;
    } else {
      chunk_.resize(size);
      const bool is_whole = compression == "bz2"   ? InflateBz2(data, chunk_)
                            : compression == "lz4" ? lz4_.Inflate(data, chunk_)
                                                   : false;
      if (is_whole) {
        TakeRecords(chunk_);
      } else {
        ++unreadable_chunks_;
      }
    }
    is_in_chunk_ = false;
  }

  RosIntake& recording_;
  std::map<std::uint32_t, MessageTaker> connections_;
  std::vector<std::uint8_t> chunk_;
  Lz4Inflater lz4_;
  std::uint64_t unreadable_chunks_ = 0;
  std::uint64_t unknown_connections_ = 0;
  std::uint64_t truncated_bytes_ = 0;
  bool has_magic_ = false;
  bool is_foreign_ = false;
  bool is_in_chunk_ = false;
};

}  // namespace

bool BeginsLikeRosbag1(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kBagMagic.size() &&
         std::equal(kBagMagic.begin(), kBagMagic.end(), bytes.begin());
}

SourceLog ParseRosbag1(std::span<const std::uint8_t> bytes, std::size_t block,
                       const SourceOptions& options) {
  RosIntake recording(options);
  Rosbag1File bag(recording);
  TakeInBlocks(bytes, block, [&](BagBytes part, bool at_end) { return bag.Consume(part, at_end); });
  SourceLog log = std::move(recording).Finish();
  log.summary += bag.Summary();
  return log;
}

Result<SourceLog> ReadRosbag1(const std::filesystem::path& file, const SourceOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  RosIntake recording(options);
  Rosbag1File bag(recording);
  const auto read = ReadInBlocks(
      file, [&](BagBytes bytes, bool at_end) { return bag.Consume(bytes, at_end); },
      options.progress);
  if (!read) return tl::unexpected(read.error());
  if (!bag.IsBag()) {
    return Refuse(file.string(), "is not a ROS 1 recording of version 2.0", "give a .bag file");
  }
  SourceLog log = std::move(recording).Finish();
  log.summary += bag.Summary();
  return log;
}

}  // namespace telltale
