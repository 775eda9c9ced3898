#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "telltale/idl/codec/messages/diagnosis.hpp"

namespace SQLite {
class Database;
}

namespace telltale {

/// The last diagnosis of every vehicle on disk, beside the models.
/// Throws SQLite::Exception where the disk refuses, and std::runtime_error, which names the field,
/// where a diagnosis could not be read back. Earlier diagnoses then stay as they are. Not thread
/// safe.
class DiagnosisStore {
 public:
  /// In the database of `directory`, OpenDatabase().
  explicit DiagnosisStore(const std::filesystem::path& directory);
  ~DiagnosisStore();
  DiagnosisStore(DiagnosisStore&&) noexcept;
  DiagnosisStore& operator=(DiagnosisStore&&) noexcept;

  /// Replaces the vehicle's earlier diagnosis. It is on disk on return.
  void Save(const PublishedDiagnosis& diagnosis);

  /// Nothing where there is none, and where it cannot be read.
  std::optional<PublishedDiagnosis> Last(std::string_view vehicle_id) const;

 private:
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace telltale
