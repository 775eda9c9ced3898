#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace telltale {

/// What an MCAP file begins and ends with.
inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

/// Whether bytes begin with MCAP's magic.
inline bool BeginsLikeMcap(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with(kMcapMagic);
}

/// What stands before the content of each record: its opcode and its length, 8 bytes.
inline constexpr std::size_t kMcapRecordHeader = 9;

/// The records that are read or written; others are passed over.
struct McapOpcode {
  enum : std::uint8_t {
    kHeader = 1,
    kFooter = 2,
    kSchema = 3,
    kChannel = 4,
    kMessage = 5,
    kChunk = 6,
    kMessageIndex = 7,
    kChunkIndex = 8,
    kStatistics = 11,
    kDataEnd = 15
  };
};

/// Little-endian fields of a record in their order; a field beyond the end makes Ok() false.
class McapFields {
 public:
  using Bytes = std::span<const std::uint8_t>;

  explicit McapFields(Bytes bytes) : bytes_(bytes) {}

  template <class Number>
  [[gnu::always_inline]] Number Read() {
    static_assert(std::endian::native == std::endian::little);
    Number value{};
    const Bytes raw = Take(sizeof(Number));
    if (ok_) std::memcpy(&value, raw.data(), sizeof(Number));
    return value;
  }
  std::string_view Text() {
    const Bytes raw = Take(Read<std::uint32_t>());
    return {reinterpret_cast<const char*>(raw.data()), raw.size()};
  }
  [[gnu::always_inline]] Bytes Take(std::uint64_t length) {
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

/// The records of some bytes, one after the other, as far as they are whole.
class McapRecords {
 public:
  explicit McapRecords(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  struct Record {
    std::uint8_t opcode = 0;
    std::span<const std::uint8_t> content;
  };

  /// False: what is left is no whole record.
  bool Next(Record& record) {
    if (rest_.size() < kMcapRecordHeader) return false;
    McapFields header(rest_);
    record.opcode = header.Read<std::uint8_t>();
    const auto length = header.Read<std::uint64_t>();
    if (length > rest_.size() - kMcapRecordHeader) return false;
    record.content = rest_.subspan(kMcapRecordHeader, static_cast<std::size_t>(length));
    rest_ = rest_.subspan(kMcapRecordHeader + static_cast<std::size_t>(length));
    return true;
  }

  std::span<const std::uint8_t> Rest() const { return rest_; }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace telltale
