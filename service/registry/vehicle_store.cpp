#include "telltale/service/registry/vehicle_store.hpp"

#include <spdlog/spdlog.h>

#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/service/storage/checked_serialisation.hpp"
#include "telltale/service/storage/stored_blob.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

std::optional<Vehicle> ReadVehicle(const Row& row, const std::string& database) {
  proto::Vehicle message;
  if (ReadBlob(row, "vehicle", message)) {
    if (auto vehicle = VehicleOf(message)) return *std::move(vehicle);
  }
  spdlog::error("{}: what is stored of {} is no vehicle", database, row.Text("vehicle_id"));
  return std::nullopt;
}

}  // namespace

VehicleStore::VehicleStore(const Storage& storage)
    : storage_(storage), database_(storage.Open(VehiclesSchema())) {}

std::vector<Vehicle> VehicleStore::All() const {
  std::vector<Vehicle> vehicles;
  database_->Query("SELECT * FROM announced_vehicles ORDER BY vehicle_id", {}, [&](const Row& row) {
    if (auto read = ReadVehicle(row, database_->name())) {
      vehicles.push_back(*std::move(read));
    }
  });
  return vehicles;
}

std::set<std::string> VehicleStore::Save(const std::vector<Change>& changes) {
  std::set<int> slices;
  for (const Change& change : changes) slices.insert(SliceOf(change.vehicle_id));
  std::set<std::string> saved;
  database_->InTransaction([&] {
    const std::set<int> held = storage_.LockLeases(*database_, slices);
    for (const Change& change : changes) {
      if (!held.contains(SliceOf(change.vehicle_id))) continue;
      Make(change);
      saved.insert(change.vehicle_id);
    }
  });
  return saved;
}

/// The caller has begun a transaction.
void VehicleStore::Make(const Change& change) {
  if (!change.vehicle) {
    database_->Execute("DELETE FROM announced_vehicles WHERE vehicle_id = $1", {change.vehicle_id});
    return;
  }
  const proto::Vehicle message = ToProto(*change.vehicle);
  const std::string blob = SerialiseChecked(message, VehicleOf(message));
  database_->Execute(
      "INSERT INTO announced_vehicles (vehicle_id, vehicle, checksum) VALUES ($1, $2, $3)"
      " ON CONFLICT (vehicle_id) DO UPDATE SET vehicle = excluded.vehicle,"
      " checksum = excluded.checksum",
      {change.vehicle_id, Blob(blob), std::int64_t{ChecksumOf(blob)}});
}

}  // namespace telltale
