#pragma once

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/service/diagnosis/diagnosis_store.hpp"
#include "telltale/service/ingest/fleet.hpp"

namespace telltale {

/// The last diagnosis of every vehicle, on disk and on the bus. It is saved before it is published,
/// and is published again once the daemon serves. Not thread safe.
class PublishedDiagnoses {
 public:
  PublishedDiagnoses(const Participant& participant, DiagnosisStore store);

  /// Publishes the last diagnosis of every vehicle.
  void BeginPublishing(const Fleet& fleet);

  /// Saves a diagnosis that another daemon has published. Throws as DiagnosisStore::Save.
  void Learn(const PublishedDiagnosis& diagnosis) { store_.Save(diagnosis); }

  /// Saves, then publishes. Throws as DiagnosisStore::Save, and then does not publish.
  void Publish(const PublishedDiagnosis& diagnosis);

 private:
  void Announce(const PublishedDiagnosis& diagnosis);

  DiagnosisStore store_;
  Writer<telltale_wire_Diagnosis> writer_;
};

}  // namespace telltale
