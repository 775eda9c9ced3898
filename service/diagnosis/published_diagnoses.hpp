#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/service/diagnosis/diagnosis_store.hpp"
#include "telltale/service/ingest/fleet.hpp"

namespace telltale {

/// The diagnoses of every vehicle on disk, and the last on the bus. It is saved before it is
/// published, and is published again once the daemon serves. Thread safe.
class PublishedDiagnoses {
 public:
  PublishedDiagnoses(const Participant& participant, DiagnosisStore store);

  /// Publishes the last diagnosis of every vehicle, and from now on all that follow.
  void BeginPublishing(const Fleet& fleet);

  /// Saves a diagnosis that another daemon has published. Throws as DiagnosisStore::Save.
  void Learn(const PublishedDiagnosis& diagnosis);

  /// Saves a diagnosis that another daemon has published before others that are known. False where
  /// it is known itself. Throws as DiagnosisStore::SaveEarlier.
  bool LearnEarlier(const PublishedDiagnosis& diagnosis);

  /// Publishes the last diagnosis of a vehicle that is served from now on.
  void Serve(const std::string& vehicle_id);

  /// Saves, then publishes. Throws as DiagnosisStore::Save, and then does not publish.
  void Publish(const PublishedDiagnosis& diagnosis);

  /// Those that are kept, newest first. Throws as DiagnosisStore::History.
  std::vector<PublishedDiagnosis> History(std::string_view vehicle_id) const;

  /// Those of them that were published before `before_unix_s`, where that is not zero: the newest
  /// `limit`. Throws likewise.
  std::vector<PublishedDiagnosis> Earlier(std::string_view vehicle_id, double before_unix_s,
                                          std::size_t limit) const;

 private:
  void Announce(const PublishedDiagnosis& diagnosis);

  std::atomic<bool> publishing_ = false;
  mutable std::mutex mutex_;  // of store_
  DiagnosisStore store_;
  Writer<telltale_wire_Diagnosis> writer_;
};

}  // namespace telltale
