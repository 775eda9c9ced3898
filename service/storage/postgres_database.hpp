#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pqxx/pqxx>

#include "telltale/service/storage/database.hpp"
#include "telltale/service/storage/schema.hpp"
#include "telltale/service/storage/store_status.hpp"

namespace telltale {

/// A store in a database of PostgreSQL, which several stores and daemons share. A connection that
/// has broken is opened again for the next transaction; while that fails, transactions fail at once
/// and a new try is made once a second. What a transaction had done when its connection broke is
/// undone, unless it was being committed.
class PostgresDatabase : public Database {
 public:
  /// `address` is postgresql://..., as libpq reads it. What it leaves out: it is given up after 5 s
  /// where the server does not answer the connection, and 10 s later where the network is lost; a
  /// server that only reads is passed over; a transaction in which nothing happens for 5 s is
  /// undone. Throws DatabaseUnavailable where there is no connection, and DatabaseError where
  /// another version of this software wrote the store.
  PostgresDatabase(const std::string& address, const Schema& schema,
                   std::shared_ptr<StoreStatus> status);
  ~PostgresDatabase() override;

  const std::string& name() const override { return name_; }
  std::size_t Execute(const std::string& statement, const Parameters& parameters) override;
  void Query(const std::string& statement, const Parameters& parameters,
             const std::function<void(const Row&)>& take) override;
  void InTransaction(const std::function<void()>& work) override;
  std::int64_t UsedBytes() override;
  bool GiveBackSpace() override { return false; }  ///< autovacuum does

 private:
  using Clock = std::chrono::steady_clock;

  void Prepare(const Schema& schema);
  void InOwnTransaction(const std::function<void()>& work);
  std::unique_ptr<pqxx::work> Begin();
  void Connect();
  pqxx::result Run(const std::string& statement, const Parameters& parameters);
  [[noreturn]] void Fail(const pqxx::failure& error);

  const std::string name_ = "PostgreSQL";
  const std::string address_;
  const std::vector<Table> tables_;  ///< of its schema
  const std::shared_ptr<StoreStatus> status_;
  std::unique_ptr<pqxx::connection> connection_;
  std::unique_ptr<pqxx::work> transaction_;  ///< under way
  Clock::time_point next_try_{};
  std::string last_failure_;  ///< to connect
};

}  // namespace telltale
