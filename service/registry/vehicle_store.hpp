#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// The boats that have announced themselves, in the storage. Throws DatabaseError where the
/// database refuses. Not thread safe.
class VehicleStore {
 public:
  /// What becomes of one boat: kept as it is here, or forgotten where `vehicle` is empty.
  struct Change {
    std::string vehicle_id;
    std::optional<Vehicle> vehicle;
  };

  explicit VehicleStore(const Storage& storage);

  /// By their ids, without those that cannot be read.
  std::vector<Vehicle> All() const;

  /// Makes the changes in one transaction, which is on disk on return. Passes over boats that
  /// another daemon serves, and returns the ids of the others.
  std::set<std::string> Save(const std::vector<Change>& changes);

 private:
  void Make(const Change& change);

  Storage storage_;
  std::unique_ptr<Database> database_;
};

}  // namespace telltale
