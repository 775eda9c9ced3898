#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/idl/codec/messages/model.hpp"
#include "telltale/service/models/free_run_error.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// A published model with what the database adds to it.
struct StoredModel {
  PublishedModel model;
  std::optional<FreeRunError> reference_error;  ///< on the window that made the model
  std::optional<std::uint64_t> rollback_of{};   ///< the revision that it publishes again
};

/// What the newest model is compared with goes back no further: ChangeSincePredecessor().
inline constexpr std::uint64_t kModelsPerVehicle = 200;

/// Every published model in the storage, since DDS stores nothing beyond the life of a process.
/// Throws DatabaseError where the database refuses, LeaseLost where another daemon serves the boat,
/// and std::runtime_error, which names the field, where a model could not be read back. Earlier
/// models then stay as they are. Not thread safe.
class ModelStore {
 public:
  explicit ModelStore(const Storage& storage);

  /// Stores the model as its vehicle's next revision. It is on disk on return. The newest 200
  /// models of a vehicle are kept.
  StoredModel Save(const Identification& identification, double published_unix_s,
                   const std::optional<FreeRunError>& reference_error,
                   const Promotion& promotion = {}, std::optional<std::uint64_t> rollback_of = {});

  /// Stores a model that another daemon has published, in place of one of the same revision. It is
  /// on disk on return.
  void Keep(const StoredModel& stored);

  /// The revisions of the vehicle's models, oldest first.
  std::vector<std::uint64_t> Revisions(std::string_view vehicle_id) const;

  /// The vehicle's models that can be read, newest first.
  std::vector<StoredModel> History(std::string_view vehicle_id) const;

  /// When the revision of the vehicle was published; nothing where it is not kept.
  std::optional<double> PublishedUnixS(std::string_view vehicle_id, std::uint64_t revision) const;

  /// The vehicle's newest model that can be read.
  std::optional<StoredModel> Latest(std::string_view vehicle_id) const;

  /// The vehicle's newest model that can be read and that `suits`.
  std::optional<StoredModel> Newest(std::string_view vehicle_id,
                                    const std::function<bool(const StoredModel&)>& suits) const;

 private:
  void Insert(const StoredModel& stored, const Parameter& fence);

  Storage storage_;
  std::unique_ptr<Database> database_;
};

}  // namespace telltale
