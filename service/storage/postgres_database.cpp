#include "telltale/service/storage/postgres_database.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

namespace telltale {
namespace {

constexpr std::chrono::seconds kTryEvery{1};
constexpr std::int64_t kSchemaLock = 0x7e117a1e;  // any number that others do not take

const Dialect& PostgresDialect() {
  static const Dialect dialect{"BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY",
                               "BIGINT",
                               "DOUBLE PRECISION",
                               "BYTEA",
                               "",
                               "SELECT column_name AS name FROM information_schema.columns"
                               " WHERE table_schema = current_schema() AND table_name = $1"};
  return dialect;
}

/// The address with what it leaves to us.
std::string WithDefaults(std::string address) {
  // A daemon that hangs in the midst of a transaction does not keep others from its rows.
  constexpr std::array<std::pair<const char*, const char*>, 6> kDefaults = {
      {{"application_name", "telltaled"},
       {"options", "-c%20idle_in_transaction_session_timeout%3D5s"},
       {"connect_timeout", "5"},
       {"keepalives_idle", "10"},
       {"tcp_user_timeout", "10000"},
       {"target_session_attrs", "read-write"}}};
  for (const auto& [name, value] : kDefaults) {
    const std::string setting = std::string(name) + '=';
    if (address.find(setting) != std::string::npos) continue;
    address += (address.find('?') == std::string::npos ? '?' : '&') + setting + value;
  }
  return address;
}

/// A parameter as text that PostgreSQL reads; nothing for NULL.
struct AsText {
  std::optional<std::string> operator()(std::monostate) const { return std::nullopt; }
  std::optional<std::string> operator()(std::int64_t value) const { return std::to_string(value); }
  std::optional<std::string> operator()(double value) const { return fmt::format("{}", value); }
  std::optional<std::string> operator()(std::string_view value) const { return std::string(value); }
  std::optional<std::string> operator()(const Blob& value) const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text = "\\x";
    text.reserve(2 + 2 * value.bytes.size());
    for (const char c : value.bytes) {
      const auto byte = static_cast<unsigned char>(c);
      text += kDigits[byte >> 4];
      text += kDigits[byte & 15];
    }
    return text;
  }
};

class PostgresRow : public Row {
 public:
  explicit PostgresRow(const pqxx::row& row) : row_(row) {}

  bool IsNull(const char* column) const override { return row_[column].is_null(); }
  std::int64_t Integer(const char* column) const override {
    return row_[column].as<std::int64_t>();
  }
  double Real(const char* column) const override { return row_[column].as<double>(); }
  std::string Text(const char* column) const override { return row_[column].as<std::string>(); }
  std::string Bytes(const char* column) const override {
    return pqxx::binarystring(row_[column]).str();
  }

 private:
  const pqxx::row& row_;
};

/// Whether the fault is of the server's state and not of the statement: classes 53 and 57 tell of
/// its resources and of its shutdown, 25006 that it only reads since another has taken over. A
/// connection that breaks has no state.
bool IsOfTheServer(const pqxx::failure& error) {
  const auto* refusal = dynamic_cast<const pqxx::sql_error*>(&error);
  if (refusal == nullptr) return true;
  const std::string_view state = refusal->sqlstate();
  return state.empty() || state.starts_with("53") || state.starts_with("57") || state == "25006";
}

/// The first line: libpq's go on with what the server was asked.
std::string FirstLine(std::string_view text) {
  return std::string(text.substr(0, text.find('\n')));
}

}  // namespace

PostgresDatabase::PostgresDatabase(const std::string& address, const Schema& schema,
                                   std::shared_ptr<StoreStatus> status)
    : address_(WithDefaults(address)), tables_(schema.tables), status_(std::move(status)) {
  InTransaction([&] { Prepare(schema); });
}

PostgresDatabase::~PostgresDatabase() = default;

void PostgresDatabase::Prepare(const Schema& schema) {
  Query("SELECT pg_advisory_xact_lock($1)", {kSchemaLock}, [](const Row&) {});
  Execute("CREATE TABLE IF NOT EXISTS schema_versions (store TEXT PRIMARY KEY, version BIGINT)",
          {});
  int version = kNoVersion;
  Query("SELECT version FROM schema_versions WHERE store = $1", {schema.name},
        [&](const Row& row) { version = static_cast<int>(row.Integer("version")); });
  RefuseOtherVersions(schema, version, "the store of " + schema.name + " in PostgreSQL",
                      "name another database, then identify the vehicles again");
  CompleteTables(*this, schema, PostgresDialect());
  Execute(
      "INSERT INTO schema_versions VALUES ($1, $2)"
      " ON CONFLICT (store) DO UPDATE SET version = excluded.version",
      {schema.name, std::int64_t{schema.version}});
}

std::size_t PostgresDatabase::Execute(const std::string& statement, const Parameters& parameters) {
  std::size_t changed = 0;
  InOwnTransaction([&] { changed = Run(statement, parameters).affected_rows(); });
  return changed;
}

void PostgresDatabase::Query(const std::string& statement, const Parameters& parameters,
                             const std::function<void(const Row&)>& take) {
  InOwnTransaction([&] {
    for (const pqxx::row& row : Run(statement, parameters)) take(PostgresRow(row));
  });
}

/// As stored, compressed and out of line, with what a row and its key take besides: a table does
/// not become smaller when rows go, so that its own size would not do.
std::int64_t PostgresDatabase::UsedBytes() {
  constexpr std::string_view kOfEachRow = "64";
  std::int64_t bytes = 0;
  for (const Table& table : tables_) {
    std::string row(kOfEachRow);
    for (const Column& column : table.columns) {
      row += " + COALESCE(pg_column_size(" + column.name + "), 0)";
    }
    bytes += IntegerOf(*this, "SELECT COALESCE(SUM(" + row + "), 0) AS value FROM " + table.name);
  }
  return bytes;
}

/// In the transaction that is under way, where there is one.
void PostgresDatabase::InOwnTransaction(const std::function<void()>& work) {
  transaction_ ? work() : InTransaction(work);
}

void PostgresDatabase::InTransaction(const std::function<void()>& work) {
  try {
    transaction_ = Begin();
    work();
    transaction_->commit();
    transaction_.reset();
    status_->NoteSuccess(name_);
  } catch (const pqxx::failure& error) {
    Fail(error);
  } catch (...) {
    transaction_.reset();
    throw;
  }
}

/// A connection that broke since it was last used is opened again.
std::unique_ptr<pqxx::work> PostgresDatabase::Begin() {
  if (connection_) {
    try {
      return std::make_unique<pqxx::work>(*connection_);
    } catch (const pqxx::failure&) {
      connection_.reset();
    }
  }
  Connect();
  return std::make_unique<pqxx::work>(*connection_);
}

void PostgresDatabase::Connect() {
  if (Clock::now() < next_try_) throw DatabaseUnavailable(last_failure_);
  try {
    connection_ = std::make_unique<pqxx::connection>(address_);
  } catch (const pqxx::failure& error) {
    next_try_ = Clock::now() + kTryEvery;
    last_failure_ = name_ + ": " + FirstLine(error.what());
    throw;
  }
}

pqxx::result PostgresDatabase::Run(const std::string& statement, const Parameters& parameters) {
  std::vector<std::optional<std::string>> texts;
  for (const Parameter& parameter : parameters) texts.push_back(std::visit(AsText(), parameter));
  std::vector<const char*> values;
  for (const auto& text : texts) values.push_back(text ? text->c_str() : nullptr);
  return transaction_->exec_params(statement, pqxx::prepare::make_dynamic_params(values));
}

void PostgresDatabase::Fail(const pqxx::failure& error) {
  const std::string reason = name_ + ": " + FirstLine(error.what());
  const bool unavailable = IsOfTheServer(error);
  transaction_.reset();
  if (!unavailable) {
    status_->NoteFault(name_, reason);
    throw DatabaseError(reason);
  }
  connection_.reset();
  status_->NoteUnavailable(reason);
  throw DatabaseUnavailable(reason);
}

}  // namespace telltale
