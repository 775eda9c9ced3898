#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// The last diagnosis of every vehicle in the storage, beside the models.
/// Throws DatabaseError where the database refuses, LeaseLost where another daemon serves the boat,
/// and std::runtime_error, which names the field, where a diagnosis could not be read back. Earlier
/// diagnoses then stay as they are. Not thread safe.
class DiagnosisStore {
 public:
  explicit DiagnosisStore(const Storage& storage);

  /// Replaces the vehicle's earlier diagnosis. It is on disk on return.
  void Save(const PublishedDiagnosis& diagnosis);

  /// Nothing where there is none, and where it cannot be read.
  std::optional<PublishedDiagnosis> Last(std::string_view vehicle_id) const;

 private:
  Storage storage_;
  std::unique_ptr<Database> database_;
};

}  // namespace telltale
