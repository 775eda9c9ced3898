#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {

/// The models of the fleet, on disk and on the bus: what is published has been saved before, and
/// the newest model of every vehicle is published again at start. Safe to use from several threads.
class PublishedModels {
 public:
  PublishedModels(const Participant& participant, ModelStore store, const Fleet& fleet);

  /// Compares with the vehicle's earlier models, saves, then publishes. Throws SQLite::Exception
  /// where it cannot be saved; it is then not published either.
  PublishedModel Publish(Identification identification,
                         const std::optional<FreeRunError>& reference_error);

  std::optional<StoredModel> Latest(std::string_view vehicle_id) const;

  /// Tries again to publish what a stalled client held up.
  void PublishHeldUp();

  /// Keeps the exclusive ownership of the fleet's models; call from the loop whose hanging must end
  /// it.
  void AssertLiveliness() { writer_.AssertLiveliness(); }

 private:
  void Announce(const PublishedModel& model);  ///< the caller holds mutex_, once others can have it

  mutable std::mutex mutex_;
  ModelStore store_;
  Writer<telltale_wire_Model> writer_;
  std::map<std::string, StoredModel, std::less<>> latest_;
  std::set<std::string> held_up_;
};

}  // namespace telltale
