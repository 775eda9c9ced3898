#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {

/// The models of the fleet, on disk and on the bus. A model is saved before it is published, and
/// the newest model of every vehicle is published again at start. Safe to use from several threads.
class PublishedModels {
 public:
  PublishedModels(const Participant& participant, ModelStore store, const Fleet& fleet);

  /// Publishes the newest model of a vehicle that is served from now on.
  void Serve(const std::string& vehicle_id);

  /// Leaves the model of a vehicle to the daemon that serves it from now on.
  void Withdraw(const std::string& vehicle_id);

  /// Compares the model with the vehicle's earlier ones, saves it, then publishes it. Throws as
  /// ModelStore::Save, and then does not publish.
  PublishedModel Publish(Identification identification,
                         const std::optional<FreeRunError>& reference_error,
                         const Promotion& promotion);

  /// Saves and publishes an earlier model again, as the vehicle's next revision and with its
  /// verdict. Nothing where there is no such model.
  std::optional<PublishedModel> Rollback(const std::string& vehicle_id, std::uint64_t revision);

  /// The vehicle's newest model whose verdict is neither WARN nor ERROR.
  std::optional<PublishedModel> NewestSound(std::string_view vehicle_id) const;

  /// The vehicle's models, newest first.
  std::vector<StoredModel> History(std::string_view vehicle_id) const;

  std::optional<StoredModel> Latest(std::string_view vehicle_id) const;

  /// The newest of the vehicle's models that are older than revision `before`, newest first, at
  /// most `limit`.
  std::vector<StoredModel> History(std::string_view vehicle_id, std::uint64_t before,
                                   std::size_t limit) const;

  /// Publishes again the models that a stalled client has blocked.
  void PublishBlocked();

  /// Logs when other participants of the domain begin or end to publish models: another daemon
  /// whose revisions part from those of this one, or a forger. Readers believe the writer of the
  /// highest ownership strength.
  void WatchForRivals();

  /// Renews the exclusive ownership of the model topic. The caller is the loop whose stall must end
  /// that ownership.
  void AssertLiveliness() { writer_.AssertLiveliness(); }

 private:
  void Announce(const PublishedModel& model);  ///< the caller holds mutex_

  mutable std::mutex mutex_;
  ModelStore store_;
  Writer<telltale_wire_Model> writer_;
  Reader<telltale_wire_Model> own_reader_;  ///< matches every writer of models, also writer_
  std::uint32_t rivals_ = 0;
  std::map<std::string, StoredModel, std::less<>> latest_;
  std::set<std::string> blocked_;
};

}  // namespace telltale
