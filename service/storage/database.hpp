#pragma once

#include <filesystem>
#include <memory>

namespace SQLite {
class Database;
}

namespace telltale {

/// Opens models.sqlite in `directory`, and creates both where they are missing. The database holds
/// what outlives the daemon, each kind in a table of its own. A committed transaction is on disk.
/// A file that SQLite finds damaged is set aside as models.sqlite.damaged-TIME, and the rows that
/// can be read are copied into a new one; the log says so. A store of schema version 2 is brought
/// to this version. Throws SQLite::Exception where the disk refuses, and where an older or a later
/// version of this software wrote the database: the message names the file, both versions and what
/// to do.
std::unique_ptr<SQLite::Database> OpenDatabase(const std::filesystem::path& directory);

}  // namespace telltale
