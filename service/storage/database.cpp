#include "telltale/service/storage/database.hpp"

#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

namespace telltale {
namespace {

// What a program must know to write here. A table of its own does not change it: other programs
// pass over tables that they do not know.
constexpr int kSchemaVersion = 2;
constexpr int kNewDatabase = 0;

void RefuseOtherVersions(const std::filesystem::path& file, int version) {
  const std::string found = file.string() + " has schema version " + std::to_string(version) +
                            ", this program reads version " + std::to_string(kSchemaVersion);
  if (version > kSchemaVersion) {
    throw SQLite::Exception(found + "; a later version of telltale wrote it: run that version");
  }
  if (version != kNewDatabase && version < kSchemaVersion) {
    throw SQLite::Exception(found +
                            "; an older version of telltale wrote it: move the file away and start "
                            "again, then identify the vehicles again");
  }
}

}  // namespace

std::unique_ptr<SQLite::Database> OpenDatabase(const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  const std::filesystem::path file = directory / "models.sqlite";
  auto database =
      std::make_unique<SQLite::Database>(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database->setBusyTimeout(5000);
  RefuseOtherVersions(file, database->execAndGet("PRAGMA user_version").getInt());
  database->exec("PRAGMA journal_mode = WAL");
  database->exec("PRAGMA synchronous = FULL");
  database->exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  return database;
}

}  // namespace telltale
