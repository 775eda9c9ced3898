#include "telltale/service/storage/storage.hpp"

#include <utility>

#include "telltale/service/storage/postgres_database.hpp"
#include "telltale/service/storage/sqlite_database.hpp"

namespace telltale {

Storage::Storage(std::filesystem::path directory, std::string server)
    : directory_(std::move(directory)), server_(std::move(server)) {}

std::unique_ptr<Database> Storage::Open(const Schema& schema) const {
  if (!server_.empty()) return std::make_unique<PostgresDatabase>(server_, schema, status_);
  return std::make_unique<SqliteDatabase>(directory_, schema, status_);
}

}  // namespace telltale
