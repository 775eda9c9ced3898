#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace telltale {

/// The records of an ArduPilot DataFlash log, whatever they mean.
///
/// Model: a log is a row of records, each A3 95, a type byte, then the fields packed little endian
/// without padding. A record of type 128 (FMT, 89 bytes) defines a type: its length, its name, one
/// format character and one label a column. There is no checksum, so a record is believed only when
/// another header, or the end of the log, stands where it ends; what is damaged is passed over to
/// the next header and counted.
/// Source: ArduPilot, AP_Logger documentation of LogStructure.

using DataFlashBytes = std::span<const std::uint8_t>;

/// One column of a message.
struct DataFlashColumn {
  std::string label;
  char format = 0;
  std::size_t offset = 0;  ///< from the start of the record, header included

  bool operator==(const DataFlashColumn&) const = default;
};

/// A message type as its FMT record defines it. No columns when the definition contradicts itself:
/// records of such a type can be passed over by their length but not read.
struct DataFlashFormat {
  std::uint8_t type = 0;
  std::size_t length = 0;  ///< of a whole record, header included, [3, 255]
  std::string name;
  std::vector<DataFlashColumn> columns;

  const DataFlashColumn* Find(std::string_view label) const;
  bool operator==(const DataFlashFormat&) const = default;
};

/// The value of a numeric column, with the scale its format character implies: c, C, e, E
/// hundredths, L degrees from 1e-7 degrees. NaN for text and arrays. 64-bit integers round to a
/// double. Requires: `record` is a whole record of the format that `column` belongs to.
double DataFlashNumber(DataFlashBytes record, const DataFlashColumn& column);

/// The text of an n, N or Z column up to its first NUL, empty for any other; it refers to `record`.
std::string_view DataFlashText(DataFlashBytes record, const DataFlashColumn& column);

/// The number that 16 bits hold as an IEEE 754 half.
double HalfToDouble(std::uint16_t bits);

/// Told of every definition and every whole record of a log, in order.
class DataFlashConsumer {
 public:
  virtual ~DataFlashConsumer() = default;
  virtual void Define(const DataFlashFormat& format) = 0;
  virtual void Take(const DataFlashFormat& format, DataFlashBytes record) = 0;
};

/// What was wrong with the bytes themselves.
struct DataFlashDamage {
  std::uint64_t corrupt_records = 0;  ///< records not followed by a header, and runs of stray bytes
  std::uint64_t undefined_records = 0;      ///< headers of a type that no FMT record has defined
  std::uint64_t malformed_definitions = 0;  ///< FMT records that contradict themselves
  std::uint64_t redefinitions = 0;          ///< types defined anew with another layout
  std::uint64_t skipped_bytes = 0;    ///< all bytes in no whole record, truncated_bytes included
  std::uint64_t truncated_bytes = 0;  ///< the start of a record cut off by the end of the log

  bool operator==(const DataFlashDamage&) const = default;
};

/// Cuts a stream of bytes into records. Memory: the definitions only.
class DataFlashFraming {
 public:
  explicit DataFlashFraming(DataFlashConsumer& consumer);

  /// Takes records from the front of `bytes` and returns how many bytes it is done with; the caller
  /// offers the others again, with more behind them. With `last`, nothing follows and all are
  /// taken. How a log is cut into calls does not change what comes out.
  std::size_t Consume(DataFlashBytes bytes, bool last);

  const DataFlashDamage& Damage() const { return damage_; }
  std::map<std::string, std::uint64_t> RecordsByName() const;

 private:
  bool IsDefined(std::uint8_t type) const { return formats_[type].length > 0; }
  bool IsWholeRecord(DataFlashBytes rest) const;
  bool IsCutByTheEnd(DataFlashBytes rest) const;
  void Deliver(DataFlashBytes record);
  void Define(DataFlashBytes definition);
  std::size_t SkipDamage(DataFlashBytes rest);
  void CountDamage(DataFlashBytes rest);

  DataFlashConsumer& consumer_;
  std::array<DataFlashFormat, 256> formats_;  ///< length 0: not defined
  std::array<std::uint64_t, 256> records_{};  ///< of the present definition of a type
  std::map<std::string, std::uint64_t> superseded_records_;  ///< of definitions since replaced
  DataFlashDamage damage_;
  bool in_damage_ = false;
};

}  // namespace telltale
