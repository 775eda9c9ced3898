#pragma once

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/service/diagnosis/diagnosis_store.hpp"
#include "telltale/service/ingest/fleet.hpp"

namespace telltale {

/// The last diagnosis of every vehicle, on disk and on the bus: what is published has been saved
/// before, and is published again at start. Use from one thread at a time.
class PublishedDiagnoses {
 public:
  PublishedDiagnoses(const Participant& participant, DiagnosisStore store, const Fleet& fleet);

  /// Saves, then publishes. Throws SQLite::Exception where it cannot be saved; it is then not
  /// published either.
  void Publish(const PublishedDiagnosis& diagnosis);

 private:
  void Announce(const PublishedDiagnosis& diagnosis);

  DiagnosisStore store_;
  Writer<telltale_wire_Diagnosis> writer_;
};

}  // namespace telltale
