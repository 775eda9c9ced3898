#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/idl/codec/messages/model.hpp"

namespace SQLite {
class Database;
}

namespace telltale {

/// RMS free-run error over 5 s when a model was made: surge, sway (m/s), yaw (rad/s).
using FreeRunError = std::array<double, 3>;

/// A model as it is kept.
struct StoredModel {
  PublishedModel model;
  std::optional<FreeRunError> reference_error;  ///< on the window that made it
};

/// Keeps every published model on disk. DDS itself stores nothing beyond a process's life.
/// Throws SQLite::Exception when the disk will not have it, std::runtime_error naming the field
/// when it could not be read back; what was saved before stays whole. Not thread safe.
class ModelStore {
 public:
  /// In the database of `directory`, OpenDatabase().
  explicit ModelStore(const std::filesystem::path& directory);
  ~ModelStore();
  ModelStore(ModelStore&&) noexcept;
  ModelStore& operator=(ModelStore&&) noexcept;

  /// Gives the model its vehicle's next revision and keeps it; on disk when this returns.
  StoredModel Save(const Identification& identification, double published_unix_s,
                   const std::optional<FreeRunError>& reference_error);

  /// The vehicle's newest model that can be read, if any.
  std::optional<StoredModel> Latest(std::string_view vehicle_id) const;

  /// The newest that can be read and that `suits`.
  std::optional<StoredModel> Newest(std::string_view vehicle_id,
                                    const std::function<bool(const StoredModel&)>& suits) const;

 private:
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace telltale
