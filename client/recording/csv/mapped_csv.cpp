#include "telltale/client/recording/csv/mapped_csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/csv/iso_time.hpp"
#include "telltale/client/recording/mapping/mapped_recording.hpp"
#include "telltale/client/recording/trimmed.hpp"

namespace telltale {
namespace {

std::string_view Cell(std::string_view text) {
  return Trimmed(text, " \t\r\"");
}

void SplitInto(std::vector<std::string_view>& cells, std::string_view line, char separator) {
  cells.clear();
  while (true) {
    const std::size_t end = std::min(line.find(separator), line.size());
    cells.push_back(Cell(line.substr(0, end)));
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
  }
}

char SeparatorOf(std::string_view header) {
  constexpr std::array kSeparators = {',', ';', '\t'};
  return *std::max_element(kSeparators.begin(), kSeparators.end(), [&](char a, char b) {
    return std::count(header.begin(), header.end(), a) <
           std::count(header.begin(), header.end(), b);
  });
}

/// A time of ISO 8601 counts as its seconds since 1970; what is not finite as no number.
std::optional<double> NumberOf(std::string_view cell) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool is_number = !cell.empty() && error == std::errc() && end == cell.data() + cell.size();
  if (!is_number) return SecondsOfIsoTime(cell);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string> ColumnsOf(const Mapping& mapping) {
  std::vector<std::string> columns = {mapping.positions.latitude, mapping.positions.longitude,
                                      mapping.port.field, mapping.starboard.field};
  const MappedHeadings& headings = mapping.headings;
  for (const char* part : {".x", ".y", ".z", ".w"}) {
    if (headings.is_quaternion) columns.push_back(headings.field + part);
  }
  if (!headings.is_quaternion) columns.push_back(headings.field);
  for (const MappedTime* time : {&mapping.positions.time, &mapping.headings.time,
                                 &mapping.port.time, &mapping.starboard.time}) {
    columns.push_back(time->is_stamp ? time->field + ".sec" : time->field);
  }
  return columns;
}

class MappedCsv : public MessageFields {
 public:
  MappedCsv(const Mapping& mapping, std::size_t most_bytes)
      : mapping_(mapping), recording_(mapping, most_bytes) {}

  std::size_t Consume(std::span<const std::uint8_t> bytes, bool at_end) {
    return TakeLines(bytes, at_end, [this](std::string_view line) { TakeLine(line); });
  }

  std::optional<double> Number(std::string_view path) const override {
    const auto column = std::find(columns_.begin(), columns_.end(), path);
    const auto index = static_cast<std::size_t>(column - columns_.begin());
    if (column == columns_.end() || index >= cells_.size()) return std::nullopt;
    if (separator_ != ';') return NumberOf(cells_[index]);
    std::string cell(cells_[index]);
    std::replace(cell.begin(), cell.end(), ',', '.');
    return NumberOf(cell);
  }

  bool HasHeader() const { return !columns_.empty(); }
  const std::vector<std::string>& Missing() const { return missing_; }
  std::string Header() const {
    std::string header;
    for (const std::string& column : columns_) header += (header.empty() ? "" : ", ") + column;
    return header;
  }
  SourceLog Finish() && { return std::move(recording_).Finish("rows"); }

 private:
  void TakeLine(std::string_view line) {
    if (Cell(line).empty()) return;
    if (columns_.empty()) return TakeHeader(line);
    if (!missing_.empty()) return;
    SplitInto(cells_, line, separator_);
    recording_.Take("", 0.0, *this);
  }

  void TakeHeader(std::string_view line) {
    if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    separator_ = SeparatorOf(line);
    SplitInto(cells_, line, separator_);
    columns_.assign(cells_.begin(), cells_.end());
    for (const std::string& wanted : ColumnsOf(mapping_)) {
      const bool is_there = std::find(columns_.begin(), columns_.end(), wanted) != columns_.end();
      const bool is_said = std::find(missing_.begin(), missing_.end(), wanted) != missing_.end();
      if (!is_there && !is_said) missing_.push_back(wanted);
    }
  }

  const Mapping& mapping_;
  MappedRecording recording_;
  char separator_ = ',';
  std::vector<std::string> columns_;
  std::vector<std::string> missing_;
  std::vector<std::string_view> cells_;
};

std::optional<Refusal> NotForCsv(const Mapping& mapping) {
  for (const std::string* topic : {&mapping.positions.topic, &mapping.headings.topic,
                                   &mapping.port.topic, &mapping.starboard.topic}) {
    if (topic->empty()) continue;
    return Refusal{"mapping " + mapping.name, "names the topic " + *topic + ", and a CSV has none",
                   "name columns alone"};
  }
  for (const MappedTime* time : {&mapping.positions.time, &mapping.headings.time,
                                 &mapping.port.time, &mapping.starboard.time}) {
    if (!time->field.empty()) continue;
    return Refusal{"mapping " + mapping.name, "names no column of times",
                   "add time { field: \"the column\" unit: \"s\" }"};
  }
  return std::nullopt;
}

}  // namespace

Result<SourceLog> ReadMappedCsv(const std::filesystem::path& file, const Mapping& mapping,
                                const SourceOptions& options) {
  if (auto refusal = NotForCsv(mapping)) return tl::unexpected(*std::move(refusal));
  MappedCsv csv(mapping, options.memory_bytes);
  const auto read = ReadInBlocks(
      file,
      [&](std::span<const std::uint8_t> bytes, bool at_end) { return csv.Consume(bytes, at_end); },
      options.progress);
  if (!read) return tl::unexpected(read.error());
  if (!csv.HasHeader()) {
    return Refuse(file.string(), "is empty", "give a file with a header row and a row per sample");
  }
  if (!csv.Missing().empty()) {
    return Refuse(
        file.string(),
        "has no column " + csv.Missing().front() + ", only " + csv.Header().substr(0, 300),
        "name the columns of this file in the mapping");
  }
  return std::move(csv).Finish();
}

}  // namespace telltale
