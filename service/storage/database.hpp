#pragma once

#include <filesystem>
#include <memory>

namespace SQLite {
class Database;
}

namespace telltale {

/// Opens or creates models.sqlite in `directory`, which is made if it is not there: what outlives
/// the daemon stands in it, each kind in a table of its own. What is committed is on disk.
/// Throws SQLite::Exception when the disk will not have it or a later program has written it.
std::unique_ptr<SQLite::Database> OpenDatabase(const std::filesystem::path& directory);

}  // namespace telltale
