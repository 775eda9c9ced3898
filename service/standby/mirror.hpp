#pragma once

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/service/diagnosis/published_diagnoses.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/baseline_recordings.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/standby/role.hpp"

namespace telltale {

/// Takes over what another daemon publishes into this daemon's store: models at all times, since
/// two daemons that could not hear each other may both have published, and diagnoses while this
/// daemon does not serve. A model that was just made gets its baseline recording and its reference
/// error from this daemon's own window, which holds the same telemetry. Belongs to the thread of
/// the wait set; a fault of the store is logged.
class Mirror {
 public:
  struct Into {
    const Fleet& fleet;
    PublishedModels& models;
    PublishedDiagnoses& diagnoses;
    BaselineRecordings& baselines;
  };

  Mirror(const Participant& participant, WaitSet& wait_set, const Role& role, const Into& into);
  Mirror(const Mirror&) = delete;
  Mirror& operator=(const Mirror&) = delete;
  ~Mirror();

 private:
  void Take(const telltale_wire_Model& wire);
  void Take(const telltale_wire_Diagnosis& wire);
  void Keep(StoredModel model);

  WaitSet& wait_set_;
  const Role& role_;
  const Into into_;
  Reader<telltale_wire_Model> model_reader_;
  Reader<telltale_wire_Diagnosis> diagnosis_reader_;
};

}  // namespace telltale
