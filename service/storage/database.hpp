#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace telltale {

/// A database that refuses. The message names the database and says why.
struct DatabaseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The same where the database cannot be reached now: the next try may succeed. What was to be
/// committed may have been.
struct DatabaseUnavailable : DatabaseError {
  using DatabaseError::DatabaseError;
};

/// The same where another daemon has taken over the boats that were to be written of: who asks
/// again asks that one.
struct LeaseLost : DatabaseUnavailable {
  using DatabaseUnavailable::DatabaseUnavailable;
};

/// Bytes as a parameter of a statement.
struct Blob {
  explicit Blob(std::string_view of) : bytes(of) {}
  std::string_view bytes;
};

/// Stands for $1, $2, ... in a statement; std::monostate is NULL. What it views outlives the call.
using Parameter = std::variant<std::monostate, std::int64_t, double, std::string_view, Blob>;
using Parameters = std::vector<Parameter>;

/// A row of an answer, valid while it is handed over. Columns go by name.
class Row {
 public:
  virtual ~Row() = default;
  virtual bool IsNull(const char* column) const = 0;
  virtual std::int64_t Integer(const char* column) const = 0;
  virtual double Real(const char* column) const = 0;
  virtual std::string Text(const char* column) const = 0;
  virtual std::string Bytes(const char* column) const = 0;
};

/// A connection to a database of either engine, for statements that both understand: parameters are
/// $1, $2, ..., a conflict is met by ON CONFLICT. Every method throws DatabaseError. Not thread
/// safe.
class Database {
 public:
  virtual ~Database() = default;

  /// What messages call it: "models.sqlite".
  virtual const std::string& name() const = 0;

  /// Outside of InTransaction() it is a transaction of its own. Returns how many rows it changed.
  virtual std::size_t Execute(const std::string& statement, const Parameters& parameters = {}) = 0;

  /// Hands over each row of the answer.
  virtual void Query(const std::string& statement, const Parameters& parameters,
                     const std::function<void(const Row&)>& take) = 0;

  /// Runs `work` as one transaction, which is on disk on return. What `work` throws undoes it.
  virtual void InTransaction(const std::function<void()>& work) = 0;

  /// Bytes that the rows of the store take, without what is free again.
  virtual std::int64_t UsedBytes() = 0;

  /// Gives at most a mebibyte of free space back to the disk, as a transaction of its own. False
  /// where there is none to give, or where the engine sees to that itself.
  virtual bool GiveBackSpace() = 0;
};

/// The whole number that a statement answers with, in its column `value`.
std::int64_t IntegerOf(Database& database, const std::string& statement,
                       const Parameters& parameters = {});

}  // namespace telltale
