#include "telltale/client/recording/csv/numeric_csv.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/trimmed.hpp"

namespace telltale {
namespace {

constexpr std::size_t kMostOfHeader = 80;  // that a refusal repeats

// Takes what stands before `separator` off the front of `text`.
std::string_view TakeUntil(char separator, std::string_view& text) {
  const auto end = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

/// For each column of the file, which of the columns asked for it is.
struct Header {
  std::vector<std::optional<std::size_t>> wanted;
  std::size_t found = 0;
};

Header ReadHeader(std::string_view line, std::span<const std::string_view> columns) {
  Header header;
  while (!line.empty()) {
    const std::string_view name = Trimmed(TakeUntil(',', line));
    const auto column = std::find(columns.begin(), columns.end(), name);
    header.wanted.emplace_back();
    if (column == columns.end()) continue;
    header.wanted.back() = static_cast<std::size_t>(column - columns.begin());
    ++header.found;
  }
  return header;
}

bool ReadNumber(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool ReadRow(std::string_view line, const Header& header, std::span<double> values) {
  std::size_t read = 0;
  for (const auto& wanted : header.wanted) {
    const std::string_view cell = Trimmed(TakeUntil(',', line));
    if (!wanted) continue;
    if (!ReadNumber(cell, values[*wanted])) return false;
    ++read;
  }
  return read == values.size();
}

std::string Joined(std::span<const std::string_view> names) {
  std::string joined;
  for (const std::string_view name : names) {
    joined.append(joined.empty() ? "" : ",").append(name);
  }
  return joined;
}

}  // namespace

void MalformedRows::Add(std::size_t line) {
  ++count;
  if (first_lines.size() < kLinesNamed) first_lines.push_back(line);
}

Result<MalformedRows> ReadCsv(const std::filesystem::path& file,
                              std::span<const std::string_view> columns,
                              const std::function<void(std::span<const double>)>& take) {
  if (auto refusal = NoFile(file)) return tl::unexpected(*std::move(refusal));
  std::optional<Header> header;
  std::string first_row;
  std::vector<double> values(columns.size());
  MalformedRows malformed;
  std::size_t line_number = 0;
  const auto take_line = [&](std::string_view line) {
    ++line_number;
    if (line_number == 1 && line.starts_with(kByteOrderMark)) {
      line.remove_prefix(kByteOrderMark.size());
    }
    if (Trimmed(line).empty()) return;
    if (!header) {
      header = ReadHeader(line, columns);
      first_row = Trimmed(line).substr(0, kMostOfHeader);
    } else if (header->found != columns.size()) {
      return;  // refused below
    } else if (ReadRow(line, *header, values)) {
      take(values);
    } else {
      malformed.Add(line_number);
    }
  };
  const auto read = ReadInBlocks(file, [&](std::span<const std::uint8_t> bytes, bool at_end) {
    return TakeLines(bytes, at_end, take_line);
  });
  if (!read) return tl::unexpected(read.error());
  if (!header) {
    return Refuse(file.string(), "is empty", "give a file with a header row and a row per sample");
  }
  if (header->found == columns.size()) return malformed;
  return Refuse(file.string(), "its header row is \"" + first_row + '"',
                "begin the file with a row that names the columns " + Joined(columns));
}

}  // namespace telltale
