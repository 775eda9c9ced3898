#include "telltale/service/storage/schema.hpp"

#include <algorithm>

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

namespace telltale {
namespace {

const std::string& TypeOf(const Column& column, const Dialect& dialect) {
  static const std::string text = "TEXT";
  switch (column.type) {
    case ColumnType::kCounter: return dialect.counter;
    case ColumnType::kInteger: return dialect.integer;
    case ColumnType::kReal: return dialect.real;
    case ColumnType::kBlob: return dialect.blob;
    case ColumnType::kText: break;
  }
  return text;
}

std::string InSql(const Column& column, const Dialect& dialect) {
  return fmt::format("{} {} {}", column.name, TypeOf(column, dialect), column.rules);
}

std::string CreationOf(const Table& table, const Dialect& dialect) {
  std::vector<std::string> parts;
  for (const Column& column : table.columns) parts.push_back(InSql(column, dialect));
  if (!table.key.empty()) {
    parts.push_back(fmt::format("PRIMARY KEY ({})", fmt::join(table.key, ", ")));
  }
  return fmt::format("CREATE TABLE {} ({}){}", table.name, fmt::join(parts, ", "),
                     table.key.empty() ? "" : dialect.table_end);
}

std::vector<std::string> ColumnsOf(Database& database, const Table& table, const Dialect& dialect) {
  std::vector<std::string> names;
  database.Query(dialect.columns_query, {table.name},
                 [&](const Row& row) { names.push_back(row.Text("name")); });
  return names;
}

}  // namespace

void RefuseOtherVersions(const Schema& schema, int version, const std::string& where,
                         const std::string& remedy) {
  const std::string found = fmt::format("{} has schema version {}, this program reads version {}",
                                        where, version, schema.version);
  if (version > schema.version) {
    throw DatabaseError(found + "; a later version of telltale wrote it: run that version");
  }
  if (version != kNoVersion && version < schema.oldest_version) {
    throw DatabaseError(found + "; an older version of telltale wrote it: " + remedy);
  }
}

void CompleteTables(Database& database, const Schema& schema, const Dialect& dialect) {
  for (const Table& table : schema.tables) {
    const auto present = ColumnsOf(database, table, dialect);
    if (present.empty()) {
      database.Execute(CreationOf(table, dialect));
      continue;
    }
    for (const Column& column : table.columns) {
      if (std::ranges::find(present, column.name) != present.end()) continue;
      database.Execute("ALTER TABLE " + table.name + " ADD COLUMN " + InSql(column, dialect));
    }
  }
}

}  // namespace telltale
