#include "telltale/service/windows/window_store.hpp"

#include <set>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/windows/window_chunk.hpp"

namespace telltale {

WindowStore::WindowStore(const Storage& storage)
    : storage_(storage), database_(storage.Open(WindowsSchema())) {}

void WindowStore::Save(const std::vector<Chunk>& chunks, const Limits& limits) {
  std::set<int> slices;
  for (const Chunk& chunk : chunks) slices.insert(SliceOf(chunk.vehicle_id));
  database_->InTransaction([&] {
    const std::set<int> held = storage_.LockLeases(*database_, slices);
    for (const Chunk& chunk : chunks) {
      if (held.contains(SliceOf(chunk.vehicle_id))) Insert(chunk, limits);
    }
  });
}

void WindowStore::Insert(const Chunk& chunk, const Limits& limits) {
  const double last_s = EndTime(chunk.samples);
  const std::string blob = PackChunk(chunk.samples);
  const std::int64_t number = IntegerOf(
      *database_, "SELECT COALESCE(MAX(number), 0) + 1 AS value FROM chunks WHERE vehicle_id = $1",
      {chunk.vehicle_id});
  database_->Execute(
      "INSERT INTO chunks (vehicle_id, number, last_s, samples, saved_unix_s)"
      " VALUES ($1, $2, $3, $4, $5)",
      {chunk.vehicle_id, number, last_s, Blob(blob), UnixNow()});
  database_->Execute("DELETE FROM chunks WHERE vehicle_id = $1 AND (last_s < $2 OR number <= $3)",
                     {chunk.vehicle_id, last_s - limits.duration_s, number - limits.most_chunks});
}

std::size_t WindowStore::Load(const std::string& vehicle_id,
                              const std::function<void(const Recording&)>& take) const {
  std::size_t unreadable = 0;
  database_->Query("SELECT samples FROM chunks WHERE vehicle_id = $1 ORDER BY number", {vehicle_id},
                   [&](const Row& row) {
                     const auto samples = UnpackChunk(row.Bytes("samples"));
                     samples ? take(*samples) : void(++unreadable);
                   });
  return unreadable;
}

}  // namespace telltale
