#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// Rows of a file that could not be read as numbers.
struct MalformedRows {
  static constexpr std::size_t kLinesNamed = 5;

  std::size_t count = 0;
  std::vector<std::size_t> first_lines;  ///< from 1, at most kLinesNamed of them

  void Add(std::size_t line);
};

/// Comma-separated numbers under a header row. Columns are found by their names, in any order,
/// others are passed over; spaces, CRLF, blank lines and a byte order mark do no harm. `take` is
/// called for each row with the values of the columns asked for, NaN and infinity included. Refuses
/// when: the file cannot be read, is empty, or its header lacks a column.
Result<MalformedRows> ReadCsv(const std::filesystem::path& file,
                              std::span<const std::string_view> columns,
                              const std::function<void(std::span<const double>)>& take);

}  // namespace telltale
