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

/// Keeps the last diagnosis of every vehicle on disk, beside the models.
/// Throws SQLite::Exception when the disk will not have it, std::runtime_error naming the field
/// when it could not be read back; what was saved before stays whole. Not thread safe.
class DiagnosisStore {
 public:
  /// In the database of `directory`, OpenDatabase().
  explicit DiagnosisStore(const std::filesystem::path& directory);
  ~DiagnosisStore();
  DiagnosisStore(DiagnosisStore&&) noexcept;
  DiagnosisStore& operator=(DiagnosisStore&&) noexcept;

  /// In place of the vehicle's one before; on disk when this returns.
  void Save(const PublishedDiagnosis& diagnosis);

  /// Nothing where there is none or it cannot be read.
  std::optional<PublishedDiagnosis> Last(std::string_view vehicle_id) const;

 private:
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace telltale
