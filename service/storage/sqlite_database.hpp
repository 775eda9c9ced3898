#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "telltale/service/storage/database.hpp"
#include "telltale/service/storage/schema.hpp"
#include "telltale/service/storage/store_status.hpp"

namespace SQLite {
class Database;
}

namespace telltale {

/// A store in a file of SQLite, with its changes in a write-ahead log of at most 4 MiB after a
/// checkpoint.
class SqliteDatabase : public Database {
 public:
  /// Opens SCHEMA.sqlite in `directory`, and creates both where they are missing. A file that
  /// SQLite finds damaged is set aside as SCHEMA.sqlite.damaged-TIME, and the rows that can be read
  /// are copied into a new one; the log says so. It is checked at the first opening that the status
  /// knows of. A file that could not give space back is rewritten so that it can. Throws
  /// DatabaseError where the disk refuses, and, leaving the file as it is, where another version of
  /// this software wrote it.
  SqliteDatabase(const std::filesystem::path& directory, const Schema& schema,
                 std::shared_ptr<StoreStatus> status);
  ~SqliteDatabase() override;

  const std::string& name() const override { return name_; }
  std::size_t Execute(const std::string& statement, const Parameters& parameters) override;
  void Query(const std::string& statement, const Parameters& parameters,
             const std::function<void(const Row&)>& take) override;
  void InTransaction(const std::function<void()>& work) override;
  std::int64_t UsedBytes() override;
  bool GiveBackSpace() override;

 private:
  void Open();
  void LetFreeSpaceGo();
  void StartAgain(const Schema& schema, const std::string& damage);
  void Prepare(const Schema& schema);
  void Noting(const std::function<void()>& work);

  const std::filesystem::path file_;
  const std::string name_;
  const std::shared_ptr<StoreStatus> status_;
  std::unique_ptr<SQLite::Database> database_;
  bool in_transaction_ = false;
};

}  // namespace telltale
