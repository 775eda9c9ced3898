#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "telltale/service/storage/database.hpp"

namespace telltale {

/// kCounter counts up by itself from row to row, and is the key of its table.
enum class ColumnType { kCounter, kInteger, kReal, kText, kBlob };

struct Column {
  std::string name;
  ColumnType type = ColumnType::kText;
  std::string rules;  ///< in SQL: "NOT NULL DEFAULT 'UNKNOWN'"
};

struct Table {
  std::string name;
  std::vector<Column> columns;
  std::vector<std::string> key;  ///< none where a column is a counter
};

/// The tables of one store.
struct Schema {
  std::string name;  ///< "models": models.sqlite
  std::vector<Table> tables;
  int version = 1;         ///< what a program must know to write here
  int oldest_version = 1;  ///< that lacks nothing but tables and columns of this one
};

/// What the engines call differently.
struct Dialect {
  std::string counter;
  std::string integer;
  std::string real;
  std::string blob;
  std::string table_end;      ///< after the columns of a table that has a key
  std::string columns_query;  ///< answers with each `name` of the columns of table $1
};

/// A version of a new store.
constexpr int kNoVersion = 0;

/// Throws DatabaseError where an older or a later version of this software wrote the store.
/// `where` names the store in the message, and `remedy` says what to do about an older one.
void RefuseOtherVersions(const Schema& schema, int version, const std::string& where,
                         const std::string& remedy);

/// Makes the tables and columns that are missing.
void CompleteTables(Database& database, const Schema& schema, const Dialect& dialect);

}  // namespace telltale
