#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace SQLite {
class Database;
}

namespace telltale {

struct SalvagedRows {
  std::size_t copied = 0;
  bool complete = true;  ///< false where a part of the table could not be read
};

/// Copies the rows of `table` that can be read from a damaged database into the table of the same
/// name in `database`. It reads from both ends of the table up to a damaged page. The columns are
/// copied by place; missing ones take their default. A row may hold wrong values: who reads it
/// checks its blob.
SalvagedRows SalvageRows(const std::filesystem::path& damaged, SQLite::Database& database,
                         const std::string& table);

}  // namespace telltale
