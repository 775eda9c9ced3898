#include "telltale/service/storage/database.hpp"

#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

namespace telltale {
namespace {

// Of what a program must know to write here. A new table, which others pass over, leaves it.
constexpr int kSchemaVersion = 1;

}  // namespace

std::unique_ptr<SQLite::Database> OpenDatabase(const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  auto database = std::make_unique<SQLite::Database>(directory / "models.sqlite",
                                                     SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database->setBusyTimeout(5000);
  database->exec("PRAGMA journal_mode = WAL");
  database->exec("PRAGMA synchronous = FULL");
  const int version = database->execAndGet("PRAGMA user_version").getInt();
  if (version > kSchemaVersion) {
    throw SQLite::Exception("models.sqlite has schema version " + std::to_string(version) +
                            ", this program knows up to " + std::to_string(kSchemaVersion));
  }
  database->exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  return database;
}

}  // namespace telltale
