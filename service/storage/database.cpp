#include "telltale/service/storage/database.hpp"

#include <optional>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include "telltale/service/storage/salvage.hpp"
#include "telltale/service/unix_now.hpp"

namespace telltale {
namespace {

// What a program must know to write here. A table of its own does not change it: other programs
// pass over tables that they do not know.
constexpr int kSchemaVersion = 3;
constexpr int kWithoutVerdicts = 2;  // models have neither verdict nor checksum
constexpr int kNewDatabase = 0;

std::unique_ptr<SQLite::Database> Open(const std::filesystem::path& file) {
  auto database =
      std::make_unique<SQLite::Database>(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database->setBusyTimeout(5000);
  return database;
}

void RefuseOtherVersions(const std::filesystem::path& file, int version) {
  const std::string found = file.string() + " has schema version " + std::to_string(version) +
                            ", this program reads version " + std::to_string(kSchemaVersion);
  if (version > kSchemaVersion) {
    throw SQLite::Exception(found + "; a later version of telltale wrote it: run that version");
  }
  if (version != kNewDatabase && version < kWithoutVerdicts) {
    throw SQLite::Exception(found +
                            "; an older version of telltale wrote it: move the file away and start "
                            "again, then identify the vehicles again");
  }
}

/// What SQLite finds wrong with the file; nothing where it is whole.
std::optional<std::string> DamageOf(const std::filesystem::path& file) {
  try {
    const auto database = Open(file);
    std::string found = database->execAndGet("PRAGMA quick_check(1)").getString();
    return found == "ok" ? std::nullopt : std::optional(std::move(found));
  } catch (const SQLite::Exception& error) {
    const int code = error.getErrorCode();
    if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT) return error.what();
    throw;
  }
}

/// Renames the database and what SQLite keeps beside it. Returns the database's new name.
std::filesystem::path SetAside(const std::filesystem::path& file) {
  const std::string suffix = ".damaged-" + std::to_string(static_cast<long>(UnixNow()));
  for (const char* part : {"-wal", "-shm", ""}) {
    const std::filesystem::path from = file.string() + part;
    if (std::filesystem::exists(from)) {
      std::filesystem::rename(from, file.string() + suffix + part);
    }
  }
  return file.string() + suffix;
}

/// Gives the models of a store without verdicts the columns that it lacks.
void AddVerdicts(SQLite::Database& database) {
  if (!database.tableExists("models")) return;
  database.exec("ALTER TABLE models ADD COLUMN verdict TEXT NOT NULL DEFAULT 'UNKNOWN'");
  database.exec("ALTER TABLE models ADD COLUMN verdict_reason TEXT NOT NULL DEFAULT ''");
  database.exec("ALTER TABLE models ADD COLUMN checksum INTEGER");
}

void CreateTables(SQLite::Database& database) {
  database.exec(
      "CREATE TABLE IF NOT EXISTS models ("
      "  vehicle_id TEXT NOT NULL, revision INTEGER NOT NULL, published_unix_s REAL NOT NULL,"
      "  model BLOB NOT NULL,"  // proto/model.proto, serialised
      "  reference_error_u REAL, reference_error_v REAL, reference_error_r REAL,"
      "  verdict TEXT NOT NULL DEFAULT 'UNKNOWN', verdict_reason TEXT NOT NULL DEFAULT '',"
      "  checksum INTEGER,"  // CRC-32 of model; none from programs that made none
      "  PRIMARY KEY (vehicle_id, revision)) WITHOUT ROWID");
  database.exec(
      "CREATE TABLE IF NOT EXISTS diagnoses ("
      "  vehicle_id TEXT NOT NULL PRIMARY KEY, model_revision INTEGER NOT NULL,"
      "  published_unix_s REAL NOT NULL,"
      "  report BLOB NOT NULL)");  // proto/report.proto, serialised
}

/// Brings the tables to this program's version, or leaves the database as it is and throws.
void PrepareSchema(SQLite::Database& database, const std::filesystem::path& file) {
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  RefuseOtherVersions(file, version);
  UseWriteAheadLog(database, "FULL");
  database.exec("PRAGMA wal_autocheckpoint = 256");  // pages, so a megabyte
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  if (version == kWithoutVerdicts) AddVerdicts(database);
  CreateTables(database);
  database.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  transaction.commit();
}

/// A new database beside the damaged one, with the rows that can still be read.
std::unique_ptr<SQLite::Database> StartAgain(const std::filesystem::path& file,
                                             const std::string& damage,
                                             const std::function<void(SQLite::Database&)>& prepare,
                                             const std::vector<std::string>& tables) {
  const std::filesystem::path damaged = SetAside(file);
  spdlog::error("{} is damaged ({}); it is set aside as {}", file.string(), damage,
                damaged.string());
  auto database = Open(file);
  prepare(*database);
  for (const std::string& table : tables) {
    const SalvagedRows rows = SalvageRows(damaged, *database, table);
    spdlog::warn("{}: {} rows of {} are read from the damaged file{}", file.string(), rows.copied,
                 table, rows.complete ? "" : "; others are lost");
  }
  return database;
}

}  // namespace

void UseWriteAheadLog(SQLite::Database& database, const char* synchronous) {
  database.exec("PRAGMA journal_mode = WAL");
  database.exec("PRAGMA synchronous = " + std::string(synchronous));
  database.exec("PRAGMA journal_size_limit = 4194304");
}

std::unique_ptr<SQLite::Database> OpenOrSalvage(
    const std::filesystem::path& file, const std::function<void(SQLite::Database&)>& prepare,
    const std::vector<std::string>& tables) {
  std::filesystem::create_directories(file.parent_path());
  if (const auto damage = DamageOf(file)) return StartAgain(file, *damage, prepare, tables);
  auto database = Open(file);
  prepare(*database);
  return database;
}

std::unique_ptr<SQLite::Database> OpenDatabase(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / "models.sqlite";
  if (std::filesystem::exists(file) && std::filesystem::file_size(file) == 0) {
    spdlog::error("{} is empty: the models of earlier runs are lost", file.string());
  }
  return OpenOrSalvage(file, [&file](SQLite::Database& database) { PrepareSchema(database, file); },
                       {"models", "diagnoses"});
}

}  // namespace telltale
