#include "telltale/client/cli/table.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

constexpr std::size_t kBetweenColumns = 2;

std::string Padded(const std::string& cell, std::size_t width, Align align) {
  const std::string blanks(width - DisplayWidth(cell), ' ');
  return align == Align::kLeft ? cell + blanks : blanks + cell;
}

std::string WithoutTrailingBlanks(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string Rule(std::size_t width) {
  std::string rule;
  for (std::size_t i = 0; i < width; ++i) rule += "─";
  return rule;
}

}  // namespace

void Table::AddRow(std::vector<std::string> cells) {
  Require(cells.size() == columns_.size(), "a cell for every column");
  lines_.push_back({"", std::move(cells)});
}

void Table::AddHeading(std::string title) {
  lines_.push_back({std::move(title), {}});
}

std::string Table::Render() const {
  const std::vector<std::size_t> widths = Widths();
  std::vector<std::string> titles;
  for (const Column& column : columns_) titles.push_back(column.title);
  const std::size_t width = std::accumulate(widths.begin(), widths.end(), std::size_t{0}) +
                            kBetweenColumns * (widths.size() - 1);
  std::string text = RenderRow(titles, widths) + '\n' + Rule(width) + '\n';
  for (const Line& line : lines_) {
    text += (line.cells.empty() ? line.heading : RenderRow(line.cells, widths)) + '\n';
  }
  return text;
}

std::vector<std::size_t> Table::Widths() const {
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) widths.push_back(DisplayWidth(column.title));
  for (const Line& line : lines_) {
    for (std::size_t i = 0; i < line.cells.size(); ++i) {
      widths[i] = std::max(widths[i], DisplayWidth(line.cells[i]));
    }
  }
  return widths;
}

std::string Table::RenderRow(const std::vector<std::string>& cells,
                             const std::vector<std::size_t>& widths) const {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) row.append(kBetweenColumns, ' ');
    row += Padded(cells[i], widths[i], columns_[i].align);
  }
  return WithoutTrailingBlanks(row);
}

std::size_t DisplayWidth(std::string_view utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char byte) { return (byte & 0xc0) != 0x80; }));
}

std::string Wrapped(std::string_view text, std::string_view indent, std::size_t columns) {
  std::istringstream words{std::string(text)};
  std::string wrapped;
  std::string line;
  for (std::string word; words >> word;) {
    const bool fits = DisplayWidth(indent) + DisplayWidth(line) + 1 + DisplayWidth(word) <= columns;
    if (!line.empty() && !fits) {
      wrapped.append(indent).append(line).append("\n");
      line.clear();
    }
    line.append(line.empty() ? "" : " ").append(word);
  }
  return line.empty() ? wrapped : wrapped.append(indent).append(line).append("\n");
}

}  // namespace telltale
