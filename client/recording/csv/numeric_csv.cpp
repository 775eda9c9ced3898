#include "telltale/client/recording/csv/numeric_csv.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/trimmed.hpp"

namespace telltale {
namespace {

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
  const auto content = ReadFile(file);
  if (!content) return tl::unexpected(content.error());
  std::string_view rest = *content;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());

  std::optional<Header> header;
  std::vector<double> values(columns.size());
  MalformedRows malformed;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = TakeUntil('\n', rest);
    if (Trimmed(line).empty()) continue;
    if (!header) {
      header = ReadHeader(line, columns);
      if (header->found == columns.size()) continue;
      return Refuse(file.string(),
                    "its header row is \"" + std::string(Trimmed(line).substr(0, 80)) + '"',
                    "begin the file with a row that names the columns " + Joined(columns));
    }
    if (ReadRow(line, *header, values)) {
      take(values);
    } else {
      malformed.Add(line_number);
    }
  }
  if (header) return malformed;
  return Refuse(file.string(), "is empty", "give a file with a header row and a row per sample");
}

}  // namespace telltale
