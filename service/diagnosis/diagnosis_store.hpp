#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// How many diagnoses of a vehicle are kept: the last and those before it.
constexpr std::size_t kDiagnosesPerVehicle = 20;

/// The newest diagnoses of every vehicle in the storage, beside the models. The time at which it
/// was published tells one of a vehicle from the others.
/// Throws DatabaseError where the database refuses, LeaseLost where another daemon serves the boat,
/// and std::runtime_error, which names the field, where a diagnosis could not be read back. Earlier
/// diagnoses then stay as they are. Not thread safe.
class DiagnosisStore {
 public:
  explicit DiagnosisStore(const Storage& storage);

  /// Becomes the vehicle's last diagnosis. It is on disk on return. The same diagnosis may be saved
  /// again; beyond kDiagnosesPerVehicle the oldest is dropped.
  void Save(const PublishedDiagnosis& diagnosis);

  /// Joins the vehicle's earlier diagnoses; becomes the last where it is newer than that. Beyond
  /// kDiagnosesPerVehicle the oldest is dropped. False where it was there before.
  bool SaveEarlier(const PublishedDiagnosis& diagnosis);

  /// Nothing where there is none, and where it cannot be read.
  std::optional<PublishedDiagnosis> Last(std::string_view vehicle_id) const;

  /// Newest first, without those that cannot be read.
  std::vector<PublishedDiagnosis> History(std::string_view vehicle_id) const;

 private:
  void KeepLastAsEarlier(std::string_view vehicle_id, double next_published_unix_s);
  void DropOldest(std::string_view vehicle_id);
  std::vector<double> PublicationTimes(std::string_view vehicle_id) const;

  Storage storage_;
  std::unique_ptr<Database> database_;
};

}  // namespace telltale
