#include "telltale/client/recording/dataflash/dataflash_records.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace telltale {
namespace {

constexpr std::uint8_t kHead1 = 0xA3;
constexpr std::uint8_t kHead2 = 0x95;
constexpr std::size_t kHeaderLength = 3;
constexpr std::size_t kLongestRecord = 255;
constexpr std::size_t kLookAhead = kLongestRecord + kHeaderLength;
constexpr std::uint8_t kFmtType = 128;
constexpr std::size_t kFmtLength = 89;
// Columns of FMT itself: Type and Length are one byte each, then Name, Format and Columns.
constexpr std::size_t kFmtTypeAt = 3;
constexpr std::size_t kFmtLengthAt = 4;
constexpr std::size_t kFmtNameAt = 5;
constexpr std::size_t kFmtFormatAt = 9;
constexpr std::size_t kFmtColumnsAt = 25;

/// Bytes that a column of this format takes; 0 for a character that no firmware writes.
std::size_t WidthOf(char format) {
  switch (format) {
    case 'b':
    case 'B':
    case 'M': return 1;
    case 'h':
    case 'H':
    case 'c':
    case 'C':
    case 'g': return 2;
    case 'i':
    case 'I':
    case 'e':
    case 'E':
    case 'L':
    case 'f':
    case 'n': return 4;
    case 'q':
    case 'Q':
    case 'd': return 8;
    case 'N': return 16;
    case 'a':
    case 'Z': return 64;
    default: return 0;
  }
}

static_assert(std::endian::native == std::endian::little, "DataFlash records are little endian");

template <class T>
T Load(DataFlashBytes record, const DataFlashColumn& column) {
  T value;
  std::memcpy(&value, record.data() + column.offset, sizeof value);
  return value;
}

std::string_view TextAt(DataFlashBytes record, std::size_t offset, std::size_t width) {
  const std::string_view field(reinterpret_cast<const char*>(record.data()) + offset, width);
  return field.substr(0, field.find('\0'));
}

bool StartsWithHeader(DataFlashBytes bytes) {
  return bytes.size() >= 2 && bytes[0] == kHead1 && bytes[1] == kHead2;
}

/// Offset of the first byte at or after `from` that starts a header or may, being the last; the
/// size if there is none.
std::size_t FindHeader(DataFlashBytes bytes, std::size_t from) {
  while (from < bytes.size()) {
    const void* hit = std::memchr(bytes.data() + from, kHead1, bytes.size() - from);
    if (hit == nullptr) return bytes.size();
    from = static_cast<std::size_t>(static_cast<const std::uint8_t*>(hit) - bytes.data());
    if (from + 1 == bytes.size() || bytes[from + 1] == kHead2) return from;
    ++from;
  }
  return bytes.size();
}

std::vector<std::string> SplitLabels(std::string_view labels) {
  std::vector<std::string> parts;
  if (labels.empty()) return parts;
  for (std::size_t begin = 0; begin <= labels.size();) {
    const std::size_t end = std::min(labels.find(',', begin), labels.size());
    parts.emplace_back(labels.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

bool IsName(std::string_view name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return c > ' ' && c < 0x7F; });
}

/// The columns; none when format, labels and length do not agree.
std::vector<DataFlashColumn> LayOutColumns(std::string_view formats, std::string_view labels,
                                           std::size_t length) {
  const std::vector<std::string> names = SplitLabels(labels);
  if (names.size() != formats.size()) return {};
  std::vector<DataFlashColumn> columns;
  std::size_t offset = kHeaderLength;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    const std::size_t width = WidthOf(formats[i]);
    if (width == 0) return {};
    columns.push_back({names[i], formats[i], offset});
    offset += width;
  }
  if (offset != length) return {};
  return columns;
}

DataFlashFormat FmtItself() {
  return {kFmtType, kFmtLength, "FMT",
          LayOutColumns("BBnNZ", "Type,Length,Name,Format,Columns", kFmtLength)};
}

}  // namespace

const DataFlashColumn* DataFlashFormat::Find(std::string_view label) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(),
                   [&](const DataFlashColumn& column) { return column.label == label; });
  return found == columns.end() ? nullptr : &*found;
}

double HalfToDouble(std::uint16_t bits) {
  const double sign = (bits & 0x8000u) != 0 ? -1.0 : 1.0;
  const int exponent = (bits >> 10) & 0x1F;
  const int fraction = bits & 0x3FF;
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  if (exponent < 31) return sign * std::ldexp(1024 + fraction, exponent - 25);
  return fraction == 0 ? sign * std::numeric_limits<double>::infinity()
                       : std::numeric_limits<double>::quiet_NaN();
}

double DataFlashNumber(DataFlashBytes record, const DataFlashColumn& column) {
  switch (column.format) {
    case 'b': return Load<std::int8_t>(record, column);
    case 'B':
    case 'M': return Load<std::uint8_t>(record, column);
    case 'h': return Load<std::int16_t>(record, column);
    case 'H': return Load<std::uint16_t>(record, column);
    case 'i': return Load<std::int32_t>(record, column);
    case 'I': return Load<std::uint32_t>(record, column);
    case 'q': return static_cast<double>(Load<std::int64_t>(record, column));
    case 'Q': return static_cast<double>(Load<std::uint64_t>(record, column));
    case 'f': return static_cast<double>(Load<float>(record, column));
    case 'd': return Load<double>(record, column);
    case 'g': return HalfToDouble(Load<std::uint16_t>(record, column));
    // Dividing gives the double nearest to the decimal value; multiplying by 0.01 would not.
    case 'c': return Load<std::int16_t>(record, column) / 100.0;
    case 'C': return Load<std::uint16_t>(record, column) / 100.0;
    case 'e': return Load<std::int32_t>(record, column) / 100.0;
    case 'E': return Load<std::uint32_t>(record, column) / 100.0;
    case 'L': return Load<std::int32_t>(record, column) / 1e7;
    default: return std::numeric_limits<double>::quiet_NaN();
  }
}

std::string_view DataFlashText(DataFlashBytes record, const DataFlashColumn& column) {
  const bool is_text = column.format == 'n' || column.format == 'N' || column.format == 'Z';
  return is_text ? TextAt(record, column.offset, WidthOf(column.format)) : std::string_view();
}

DataFlashFraming::DataFlashFraming(DataFlashConsumer& consumer) : consumer_(consumer) {
  // FMT is known beforehand: without it no definition could be read.
  formats_[kFmtType] = FmtItself();
}

std::size_t DataFlashFraming::Consume(DataFlashBytes bytes, bool last) {
  std::size_t done = 0;
  while (done < bytes.size() && (last || bytes.size() - done >= kLookAhead)) {
    const DataFlashBytes rest = bytes.subspan(done);
    if (IsWholeRecord(rest)) {
      const std::size_t length = formats_[rest[2]].length;
      Deliver(rest.first(length));
      done += length;
    } else {
      done += SkipDamage(rest);
    }
  }
  return done;
}

std::map<std::string, std::uint64_t> DataFlashFraming::RecordsByName() const {
  std::map<std::string, std::uint64_t> by_name = superseded_records_;
  for (std::size_t type = 0; type < records_.size(); ++type) {
    if (records_[type] > 0) by_name[formats_[type].name] += records_[type];
  }
  return by_name;
}

bool DataFlashFraming::IsWholeRecord(DataFlashBytes rest) const {
  if (!StartsWithHeader(rest) || rest.size() < kHeaderLength || !IsDefined(rest[2])) return false;
  const std::size_t length = formats_[rest[2]].length;
  if (rest.size() < length) return false;
  const DataFlashBytes next = rest.subspan(length);
  if (next.empty()) return true;
  return next.size() == 1 ? next[0] == kHead1 : StartsWithHeader(next);
}

void DataFlashFraming::Deliver(DataFlashBytes record) {
  in_damage_ = false;
  const std::uint8_t type = record[2];
  ++records_[type];
  if (type == kFmtType) Define(record);
  consumer_.Take(formats_[type], record);
}

void DataFlashFraming::Define(DataFlashBytes definition) {
  DataFlashFormat format{definition[kFmtTypeAt],
                         definition[kFmtLengthAt],
                         std::string(TextAt(definition, kFmtNameAt, 4)),
                         {}};
  format.columns = LayOutColumns(TextAt(definition, kFmtFormatAt, 16),
                                 TextAt(definition, kFmtColumnsAt, 64), format.length);
  DataFlashFormat& known = formats_[format.type];
  const bool is_sound = !format.columns.empty() && IsName(format.name);
  const bool changes_fmt = format.type == kFmtType && format != known;
  if (!is_sound || changes_fmt) {
    ++damage_.malformed_definitions;
    // Its length may still be right, which is enough to pass over records of this type.
    if (IsDefined(format.type) || format.length < kHeaderLength) return;
    format.name = "type " + std::to_string(format.type);
    format.columns.clear();
  }
  if (known == format) return;
  if (IsDefined(format.type)) {
    ++damage_.redefinitions;
    if (records_[format.type] > 0) superseded_records_[known.name] += records_[format.type];
    records_[format.type] = 0;
  }
  known = std::move(format);
  consumer_.Define(known);
}

bool DataFlashFraming::IsCutByTheEnd(DataFlashBytes rest) const {
  if (rest.size() == 1) return rest[0] == kHead1;
  if (!StartsWithHeader(rest)) return false;
  if (rest.size() < kHeaderLength) return true;
  const bool holds_another = FindHeader(rest, 1) + 1 < rest.size();
  return IsDefined(rest[2]) && rest.size() < formats_[rest[2]].length && !holds_another;
}

std::size_t DataFlashFraming::SkipDamage(DataFlashBytes rest) {
  std::size_t passed = rest.size();
  if (IsCutByTheEnd(rest)) {
    damage_.truncated_bytes = rest.size();
  } else {
    CountDamage(rest);
    passed = FindHeader(rest, 1);
  }
  in_damage_ = true;
  damage_.skipped_bytes += passed;
  return passed;
}

void DataFlashFraming::CountDamage(DataFlashBytes rest) {
  const bool has_header = StartsWithHeader(rest) && rest.size() >= kHeaderLength;
  if (has_header && !IsDefined(rest[2])) {
    ++damage_.undefined_records;
  } else if (has_header || !in_damage_) {
    ++damage_.corrupt_records;
  }
}

}  // namespace telltale
