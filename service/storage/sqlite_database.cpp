#include "telltale/service/storage/sqlite_database.hpp"

#include <optional>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/service/storage/salvage.hpp"

namespace telltale {
namespace {

constexpr int kLongestWaitMs = 5000;

const Dialect& SqliteDialect() {
  static const Dialect dialect{
      "INTEGER PRIMARY KEY AUTOINCREMENT",     "INTEGER", "REAL", "BLOB", " WITHOUT ROWID",
      "SELECT name FROM pragma_table_info($1)"};
  return dialect;
}

/// What SQLite finds wrong with the file; nothing where it is whole.
std::optional<std::string> DamageOf(const std::filesystem::path& file) {
  try {
    SQLite::Database database(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kLongestWaitMs);
    std::string found = database.execAndGet("PRAGMA quick_check(1)").getString();
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

void UseWriteAheadLog(SQLite::Database& database) {
  database.exec("PRAGMA journal_mode = WAL");
  database.exec("PRAGMA synchronous = FULL");
  database.exec("PRAGMA journal_size_limit = 4194304");
  database.exec("PRAGMA wal_autocheckpoint = 256");  // pages, so a megabyte
}

/// Binds $1, $2, ...
struct Binder {
  SQLite::Statement& statement;
  std::string place;

  void operator()(std::monostate) const { statement.bind(place); }
  void operator()(std::int64_t value) const { statement.bind(place, value); }
  void operator()(double value) const { statement.bind(place, value); }
  void operator()(std::string_view value) const { statement.bind(place, std::string(value)); }
  void operator()(const Blob& value) const {
    statement.bind(place, value.bytes.data(), static_cast<int>(value.bytes.size()));
  }
};

void Bind(SQLite::Statement& statement, const Parameters& parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    std::visit(Binder{statement, "$" + std::to_string(i + 1)}, parameters[i]);
  }
}

/// A flag that is up while this stands.
class Raised {
 public:
  explicit Raised(bool& flag) : flag_(flag) { flag_ = true; }
  Raised(const Raised&) = delete;
  Raised& operator=(const Raised&) = delete;
  ~Raised() { flag_ = false; }

 private:
  bool& flag_;
};

class SqliteRow : public Row {
 public:
  explicit SqliteRow(SQLite::Statement& statement) : statement_(statement) {}

  bool IsNull(const char* column) const override { return Get(column).isNull(); }
  std::int64_t Integer(const char* column) const override { return Get(column).getInt64(); }
  double Real(const char* column) const override { return Get(column).getDouble(); }
  std::string Text(const char* column) const override { return Get(column).getString(); }
  std::string Bytes(const char* column) const override { return Get(column).getString(); }

 private:
  SQLite::Column Get(const char* column) const { return statement_.getColumn(column); }

  SQLite::Statement& statement_;
};

}  // namespace

SqliteDatabase::SqliteDatabase(const std::filesystem::path& directory, const Schema& schema,
                               std::shared_ptr<StoreStatus> status)
    : file_(directory / (schema.name + ".sqlite")),
      name_(file_.filename()),
      status_(std::move(status)) {
  Noting([&] {
    std::filesystem::create_directories(directory);
    if (std::filesystem::exists(file_) && std::filesystem::file_size(file_) == 0) {
      spdlog::error("{} is empty: what earlier runs have kept in it is lost", file_.string());
    }
    if (status_->NoteOpening(name_)) {
      if (const auto damage = DamageOf(file_)) return StartAgain(schema, *damage);
    }
    Open();
    Prepare(schema);
  });
}

SqliteDatabase::~SqliteDatabase() = default;

void SqliteDatabase::Open() {
  database_ = std::make_unique<SQLite::Database>(
      file_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kLongestWaitMs);
}

/// A new database beside the damaged one, with the rows that can still be read.
void SqliteDatabase::StartAgain(const Schema& schema, const std::string& damage) {
  const std::filesystem::path damaged = SetAside(file_);
  spdlog::error("{} is damaged ({}); it is set aside as {}", file_.string(), damage,
                damaged.string());
  Open();
  Prepare(schema);
  for (const Table& table : schema.tables) {
    const SalvagedRows rows = SalvageRows(damaged, *database_, table.name);
    spdlog::warn("{}: {} rows of {} are read from the damaged file{}", file_.string(), rows.copied,
                 table.name, rows.complete ? "" : "; others are lost");
  }
}

void SqliteDatabase::Prepare(const Schema& schema) {
  const int version = database_->execAndGet("PRAGMA user_version").getInt();
  RefuseOtherVersions(schema, version, file_.string(),
                      "move the file away and start again, then identify the vehicles again");
  LetFreeSpaceGo();
  UseWriteAheadLog(*database_);
  InTransaction([&] {
    CompleteTables(*this, schema, SqliteDialect());
    database_->exec("PRAGMA user_version = " + std::to_string(schema.version));
  });
}

/// A new file is made so; an older one is rewritten. Where that fails, its free space is used again
/// and stays in the file.
void SqliteDatabase::LetFreeSpaceGo() {
  constexpr int kIncremental = 2;
  if (database_->execAndGet("PRAGMA auto_vacuum").getInt() == kIncremental) return;
  const bool is_new = std::filesystem::file_size(file_) == 0;
  database_->exec("PRAGMA auto_vacuum = INCREMENTAL");
  if (is_new) return;
  spdlog::info("{} is rewritten once, so that it can give space back", file_.string());
  try {
    database_->exec("VACUUM");
  } catch (const SQLite::Exception& error) {
    spdlog::warn("{} is not rewritten and does not become smaller: {}", file_.string(),
                 error.what());
  }
}

std::int64_t SqliteDatabase::UsedBytes() {
  return IntegerOf(*this,
                   "SELECT (page_count - freelist_count) * page_size AS value FROM"
                   " pragma_page_count, pragma_freelist_count, pragma_page_size");
}

bool SqliteDatabase::GiveBackSpace() {
  const auto free_pages = [this] {
    return IntegerOf(*this, "SELECT freelist_count AS value FROM pragma_freelist_count");
  };
  const std::int64_t before = free_pages();
  if (before == 0) return false;
  Noting([&] { database_->exec("PRAGMA incremental_vacuum(256)"); });  // pages, so a mebibyte
  return free_pages() < before;
}

std::size_t SqliteDatabase::Execute(const std::string& statement, const Parameters& parameters) {
  std::size_t changed = 0;
  Noting([&] {
    SQLite::Statement change(*database_, statement);
    Bind(change, parameters);
    changed = static_cast<std::size_t>(change.exec());
  });
  return changed;
}

void SqliteDatabase::Query(const std::string& statement, const Parameters& parameters,
                           const std::function<void(const Row&)>& take) {
  Noting([&] {
    SQLite::Statement rows(*database_, statement);
    Bind(rows, parameters);
    while (rows.executeStep()) take(SqliteRow(rows));
  });
}

void SqliteDatabase::InTransaction(const std::function<void()>& work) {
  Noting([&] {
    SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
    const Raised in_transaction(in_transaction_);
    work();
    transaction.commit();
  });
}

/// Runs `work`, and notes how it ended. A transaction counts as a whole.
void SqliteDatabase::Noting(const std::function<void()>& work) {
  try {
    work();
    if (!in_transaction_) status_->NoteSuccess(name_);
  } catch (const SQLite::Exception& error) {
    const std::string reason = name_ + ": " + error.what();
    status_->NoteFault(name_, reason);
    throw DatabaseError(reason);
  }
}

}  // namespace telltale
