#include "telltale/service/windows/window_store.hpp"

#include <optional>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>

#include "telltale/core/data/recording_parts.hpp"
#include "telltale/service/storage/database.hpp"
#include "telltale/service/windows/window_chunk.hpp"

namespace telltale {
namespace {

void CreateChunks(SQLite::Database& database) {
  UseWriteAheadLog(database, "NORMAL");  // a lost chunk is a few seconds of telemetry
  database.exec(
      "CREATE TABLE IF NOT EXISTS chunks ("
      "  vehicle_id TEXT NOT NULL, number INTEGER NOT NULL, last_s REAL NOT NULL,"
      "  samples BLOB NOT NULL,"  // PackChunk() of proto/window_chunk.proto
      "  PRIMARY KEY (vehicle_id, number)) WITHOUT ROWID");
}

}  // namespace

WindowStore::WindowStore(const std::filesystem::path& directory)
    : database_(OpenOrSalvage(directory / "windows.sqlite", CreateChunks, {"chunks"})) {}

WindowStore::~WindowStore() = default;
WindowStore::WindowStore(WindowStore&&) noexcept = default;
WindowStore& WindowStore::operator=(WindowStore&&) noexcept = default;

void WindowStore::Save(const std::vector<Chunk>& chunks, const Limits& limits) {
  SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
  for (const Chunk& chunk : chunks) Insert(chunk, limits);
  transaction.commit();
}

void WindowStore::Insert(const Chunk& chunk, const Limits& limits) {
  const double last_s = EndTime(chunk.samples);
  const std::string blob = PackChunk(chunk.samples);
  SQLite::Statement next(*database_,
                         "SELECT COALESCE(MAX(number), 0) + 1 FROM chunks WHERE vehicle_id = ?");
  next.bind(1, chunk.vehicle_id);
  next.executeStep();
  const std::int64_t number = next.getColumn(0).getInt64();
  next.reset();
  SQLite::Statement insert(*database_, "INSERT INTO chunks VALUES (?, ?, ?, ?)");
  insert.bind(1, chunk.vehicle_id);
  insert.bind(2, number);
  insert.bind(3, last_s);
  insert.bind(4, blob.data(), static_cast<int>(blob.size()));
  insert.exec();
  SQLite::Statement drop(*database_,
                         "DELETE FROM chunks WHERE vehicle_id = ? AND (last_s < ? OR number <= ?)");
  drop.bind(1, chunk.vehicle_id);
  drop.bind(2, last_s - limits.duration_s);
  drop.bind(3, number - limits.most_chunks);
  drop.exec();
}

std::size_t WindowStore::Load(const std::string& vehicle_id,
                              const std::function<void(const Recording&)>& take) const {
  std::size_t unreadable = 0;
  SQLite::Statement rows(*database_,
                         "SELECT samples FROM chunks WHERE vehicle_id = ? ORDER BY number");
  rows.bind(1, vehicle_id);
  while (rows.executeStep()) {
    const SQLite::Column blob = rows.getColumn(0);
    const auto samples = UnpackChunk(
        {static_cast<const char*>(blob.getBlob()), static_cast<std::size_t>(blob.getBytes())});
    samples ? take(*samples) : void(++unreadable);
  }
  return unreadable;
}

}  // namespace telltale
