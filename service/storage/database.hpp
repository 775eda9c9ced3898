#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace SQLite {
class Database;
}

namespace telltale {

/// Keeps changes in a write-ahead log of at most 4 MiB after a checkpoint. `synchronous` is
/// SQLite's: FULL puts each committed transaction on disk, NORMAL may lose the latest at a power
/// failure.
void UseWriteAheadLog(SQLite::Database& database, const char* synchronous);

/// Opens a database, and creates it where it is missing. `prepare` creates its tables, and may
/// throw to leave the file as it is. A file that SQLite finds damaged is set aside as
/// FILE.damaged-TIME, and the rows of `tables` that can be read are copied into a new one; the log
/// says so. Throws SQLite::Exception where the disk refuses.
std::unique_ptr<SQLite::Database> OpenOrSalvage(
    const std::filesystem::path& file, const std::function<void(SQLite::Database&)>& prepare,
    const std::vector<std::string>& tables);

/// Opens models.sqlite in `directory`, and creates both where they are missing. The database holds
/// what outlives the daemon, each kind in a table of its own. A committed transaction is on disk.
/// A file that SQLite finds damaged is set aside as models.sqlite.damaged-TIME, and the rows that
/// can be read are copied into a new one; the log says so. A store of schema version 2 is brought
/// to this version. Throws SQLite::Exception where the disk refuses, and where an older or a later
/// version of this software wrote the database: the message names the file, both versions and what
/// to do.
std::unique_ptr<SQLite::Database> OpenDatabase(const std::filesystem::path& directory);

}  // namespace telltale
