#include "telltale/service/storage/storage.hpp"

#include <utility>

#include "telltale/service/storage/postgres_database.hpp"
#include "telltale/service/storage/sqlite_database.hpp"

namespace telltale {

Storage::Storage(std::filesystem::path directory, std::string server, Writes writes)
    : directory_(std::move(directory)),
      server_(std::move(server)),
      held_(writes == Writes::kNeedLeases ? std::make_shared<HeldSlices>() : nullptr) {}

std::unique_ptr<Database> Storage::Open(const Schema& schema) const {
  if (!server_.empty()) return std::make_unique<PostgresDatabase>(server_, schema, status_);
  return std::make_unique<SqliteDatabase>(directory_, schema, status_);
}

std::set<int> Storage::LockLeases(Database& database, const std::set<int>& slices) const {
  if (!held_) return slices;
  std::set<int> locked;
  const Slices held = held_->Get();
  for (const int slice : slices) {  // in their order, so that no two wait for each other
    const auto lease = held.find(slice);
    if (lease == held.end()) continue;
    database.Query("SELECT slice FROM slices WHERE slice = $1 AND fence = $2 FOR SHARE",
                   {std::int64_t{slice}, lease->second}, [&](const Row&) { locked.insert(slice); });
    if (!locked.contains(slice)) {
      throw LeaseLost("slice " + std::to_string(slice) + " has a newer lease");
    }
  }
  return locked;
}

Parameter Storage::RequireLease(Database& database, std::string_view vehicle_id) const {
  if (!held_) return std::monostate();
  const auto fence = held_->FenceOf(vehicle_id);
  if (fence && !LockLeases(database, {SliceOf(vehicle_id)}).empty()) return *fence;
  throw LeaseLost("another daemon serves '" + std::string(vehicle_id) + "' now");
}

}  // namespace telltale
