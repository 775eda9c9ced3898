#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/report/number_text.hpp"

namespace telltale {

inline constexpr std::size_t kTerminalColumns = 80;

enum class Align { kLeft, kRight };

struct Column {
  std::string title;
  Align align = Align::kLeft;
};

/// Rows under titles, columns as wide as their widest cell, counted in characters, not bytes.
class Table {
 public:
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// Requires: as many cells as columns.
  void AddRow(std::vector<std::string> cells);

  /// A line that names the rows below it.
  void AddHeading(std::string title);

  /// Titles, a rule, the rows; every line ends in a line feed and in no blank.
  std::string Render() const;

 private:
  struct Line {
    std::string heading;
    std::vector<std::string> cells;
  };
  std::vector<std::size_t> Widths() const;
  std::string RenderRow(const std::vector<std::string>& cells,
                        const std::vector<std::size_t>& widths) const;

  std::vector<Column> columns_;
  std::vector<Line> lines_;
};

/// Characters of a UTF-8 text, each taken to be one column wide.
std::size_t DisplayWidth(std::string_view utf8);

/// Words broken into lines of at most `columns`, each begun with `indent` and ended by a line feed.
std::string Wrapped(std::string_view text, std::string_view indent = "",
                    std::size_t columns = kTerminalColumns);

}  // namespace telltale
