#pragma once

#include <atomic>
#include <chrono>
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
#include "telltale/service/role.hpp"
#include "telltale/service/storage/write_durations.hpp"

namespace telltale {

/// The models of the fleet, on disk and on the bus. A model is saved before it is published, and
/// the newest model of every vehicle is published again once the daemon serves. Safe to use from
/// several threads.
class PublishedModels {
 public:
  PublishedModels(const Participant& participant, ModelStore store, const Fleet& fleet,
                  const Role& role);

  /// Publishes the newest model of every vehicle, and from now on all that follow. `contract` is
  /// that of the writer, made from ModelQos().
  void BeginPublishing(const Qos& contract);

  /// Publishes the newest model of a vehicle that is served from now on.
  void Serve(const std::string& vehicle_id);

  /// Leaves the model of a vehicle to the daemon that serves it from now on.
  void Withdraw(const std::string& vehicle_id);

  /// Saves a model that another daemon has published, where it is newer than this daemon's; while
  /// this daemon serves it then publishes it too. Where both have given the same revision to
  /// different models, which is possible only while neither hears the other, the one that serves
  /// publishes its own again as the next revision. Throws as ModelStore::Keep.
  void Learn(const StoredModel& model);

  /// Saves an earlier model that another daemon has published, in the place of another of the same
  /// revision. Throws as ModelStore::Keep.
  void LearnEarlier(const PublishedModel& model);

  /// The revision after which those of the vehicle that are kept have a hole; nothing where they
  /// follow each other up to the newest, from the first or from the oldest of 200.
  std::optional<std::uint64_t> HoleAfter(std::string_view vehicle_id) const;

  /// Waits until all readers have what was published; false where that takes longer.
  bool AwaitReceipt(std::chrono::nanoseconds timeout);

  /// Compares the model with the vehicle's earlier ones, saves it, then publishes it. Throws as
  /// ModelStore::Save, and std::runtime_error where the daemon does not serve, and then does not
  /// publish.
  PublishedModel Publish(Identification identification,
                         const std::optional<FreeRunError>& reference_error,
                         const Promotion& promotion);

  /// Saves and publishes an earlier model again, as the vehicle's next revision and with its
  /// verdict. Nothing where there is no such model. Throws as Publish.
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

  /// The oldest of the vehicle's models that are later than revision `after`, oldest first, at most
  /// `limit`.
  std::vector<PublishedModel> Later(std::string_view vehicle_id, std::uint64_t after,
                                    std::size_t limit) const;

  /// Publishes again the models that a stalled client has blocked.
  void PublishBlocked();

  /// Logs when other participants of the domain begin or end to publish models beside the daemon
  /// that serves: another daemon whose revisions part from those of this one, or a forger. Readers
  /// believe the writer of the highest ownership strength.
  void WatchForRivals();

  /// Renews the exclusive ownership of the model topic. The caller is the loop whose stall must end
  /// that ownership.
  void AssertLiveliness();

  /// How many subscribers of models this daemon is connected to.
  std::uint32_t Matched() const { return publishing_ ? writer_->Matched() : 0; }

  WriteDurations::Sum Written() const { return written_.Total(); }

 private:
  // The caller of these holds mutex_.
  void RequireRole() const;
  std::optional<PublishedModel> PublishAgain(const std::string& vehicle_id, std::uint64_t revision);
  void Announce(const PublishedModel& model);  ///< while the daemon serves

  const Participant& participant_;
  const Role& role_;
  mutable std::mutex mutex_;
  ModelStore store_;
  std::optional<Writer<telltale_wire_Model>> writer_;
  std::atomic<bool> publishing_ = false;      ///< writer_ is there, and stays
  Reader<telltale_wire_Model> rival_reader_;  ///< matches the writers of others
  WriteDurations written_;
  std::uint32_t rivals_ = 0;
  std::map<std::string, StoredModel, std::less<>> latest_;
  std::set<std::string> blocked_;
};

}  // namespace telltale
