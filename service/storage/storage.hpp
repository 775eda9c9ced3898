#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "telltale/service/storage/database.hpp"
#include "telltale/service/storage/schema.hpp"
#include "telltale/service/storage/store_status.hpp"

namespace telltale {

/// Where the daemon keeps what outlives it: by SQLite in files of a directory, or in a database of
/// PostgreSQL. Copies share their status.
class Storage {
 public:
  /// `server` is a postgresql:// address as libpq reads it; without one, SQLite keeps everything.
  explicit Storage(std::filesystem::path directory, std::string server = "");

  /// A connection to the store of this schema, which is created where it is missing, and brought
  /// from an older version to that of the schema. Throws DatabaseError where that cannot be done.
  /// See SqliteDatabase and PostgresDatabase.
  std::unique_ptr<Database> Open(const Schema& schema) const;

  StoreStatus& status() const { return *status_; }

 private:
  std::filesystem::path directory_;
  std::string server_;
  std::shared_ptr<StoreStatus> status_ = std::make_shared<StoreStatus>();
};

}  // namespace telltale
