#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "telltale/service/storage/database.hpp"
#include "telltale/service/storage/held_slices.hpp"
#include "telltale/service/storage/schema.hpp"
#include "telltale/service/storage/store_status.hpp"

namespace telltale {

/// Where the daemon keeps what outlives it: by SQLite in files of a directory, or in a database of
/// PostgreSQL, which it may share with other daemons. Copies share their status and their slices.
class Storage {
 public:
  /// Whether writes need the lease of a slice.
  enum class Writes { kFree, kNeedLeases };

  /// `server` is a postgresql:// address as libpq reads it; without one, SQLite keeps everything.
  explicit Storage(std::filesystem::path directory, std::string server = "",
                   Writes writes = Writes::kFree);

  /// A connection to the store of this schema, which is created where it is missing, and brought
  /// from an older version to that of the schema. Throws DatabaseError where that cannot be done.
  /// See SqliteDatabase and PostgresDatabase.
  std::unique_ptr<Database> Open(const Schema& schema) const;

  StoreStatus& status() const { return *status_; }

  /// The slices that this daemon holds; null where writes need no lease.
  HeldSlices* held() const { return held_.get(); }

  /// The slices of these that this daemon serves; all of them where writes need no lease. No other
  /// takes them over until the transaction under way has ended. Throws LeaseLost where the database
  /// knows a newer lease of one of them.
  std::set<int> LockLeases(Database& database, const std::set<int>& slices) const;

  /// The same for the slice of one vehicle. Throws LeaseLost where this daemon does not serve it.
  /// Returns the fence, or NULL where writes need no lease.
  Parameter RequireLease(Database& database, std::string_view vehicle_id) const;

 private:
  std::filesystem::path directory_;
  std::string server_;
  std::shared_ptr<StoreStatus> status_ = std::make_shared<StoreStatus>();
  std::shared_ptr<HeldSlices> held_;
};

}  // namespace telltale
