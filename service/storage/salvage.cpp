#include "telltale/service/storage/salvage.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

namespace telltale {
namespace {

/// "INSERT OR IGNORE INTO table (a, b) VALUES (?, ?)" for the columns of these rows.
std::string InsertOf(SQLite::Statement& rows, const std::string& table) {
  std::string names;
  std::string places;
  for (int i = 0; i < rows.getColumnCount(); ++i) {
    names += (i == 0 ? "" : ", ") + std::string(rows.getColumnName(i));
    places += i == 0 ? "?" : ", ?";
  }
  return "INSERT OR IGNORE INTO " + table + " (" + names + ") VALUES (" + places + ")";
}

void BindColumn(SQLite::Statement& insert, int place, const SQLite::Column& column) {
  if (column.isInteger()) {
    insert.bind(place, column.getInt64());
  } else if (column.isFloat()) {
    insert.bind(place, column.getDouble());
  } else if (column.isText()) {
    insert.bind(place, column.getString());
  } else if (column.isBlob()) {
    insert.bind(place, column.getBlob(), column.getBytes());
  } else {
    insert.bind(place);
  }
}

/// Copies rows in this order until the end or until a page that cannot be read.
SalvagedRows CopyInOrder(SQLite::Database& from, SQLite::Database& to, const std::string& table,
                         const std::string& order) {
  SalvagedRows result;
  try {
    SQLite::Statement rows(from,
                           "SELECT * FROM " + table + " ORDER BY 1 " + order + ", 2 " + order);
    SQLite::Statement insert(to, InsertOf(rows, table));
    while (rows.executeStep()) {
      for (int i = 0; i < rows.getColumnCount(); ++i) BindColumn(insert, i + 1, rows.getColumn(i));
      result.copied += static_cast<std::size_t>(insert.exec());
      insert.reset();
    }
  } catch (const SQLite::Exception&) {
    result.complete = false;
  }
  return result;
}

}  // namespace

SalvagedRows SalvageRows(const std::filesystem::path& damaged, SQLite::Database& database,
                         const std::string& table) {
  try {
    SQLite::Database from(damaged, SQLite::OPEN_READWRITE);
    SalvagedRows rows = CopyInOrder(from, database, table, "ASC");
    if (!rows.complete) rows.copied += CopyInOrder(from, database, table, "DESC").copied;
    return rows;
  } catch (const SQLite::Exception&) {
    return {0, false};
  }
}

}  // namespace telltale
