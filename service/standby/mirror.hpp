#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"
#include "telltale/service/diagnosis/published_diagnoses.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/baseline_recordings.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/role.hpp"

namespace telltale {

/// Takes over what another daemon publishes into this daemon's store: models at all times, since
/// two daemons that could not hear each other may both have published, and diagnoses while this
/// daemon does not serve. A model that was just made gets its baseline recording and its reference
/// error from this daemon's own window, which holds the same telemetry. Models and diagnoses that
/// were published while this daemon was down are asked for, some of one vehicle at a time, and so
/// are the models that this daemon kept last before: of what it kept in the instant of its death
/// nobody may have heard. Belongs to the thread of the wait set; a fault of the store is logged.
class Mirror {
 public:
  using Clock = std::chrono::steady_clock;

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

  /// Asks for what is missing, and again where no answer came.
  void FillHoles(Clock::time_point now);

 private:
  std::optional<std::uint64_t> MissingAfter(const std::string& vehicle_id) const;
  void Ask(FleetRequest request, const std::string& vehicle_id, Clock::time_point now);
  void Take(const FleetReply& reply);
  void TakeModels(const FleetReply& reply);
  void TakeDiagnoses(const FleetReply& reply);
  void Take(const telltale_wire_Model& wire);
  void Take(const telltale_wire_Diagnosis& wire);
  void Keep(StoredModel model);

  const Participant& participant_;
  WaitSet& wait_set_;
  const Role& role_;
  const Into into_;
  Reader<telltale_wire_Model> model_reader_;
  Reader<telltale_wire_Diagnosis> diagnosis_reader_;
  Reader<telltale_wire_FleetReply> reply_reader_;
  /// While there is something to ask for: one that is silent for long is taken for broken.
  std::optional<Writer<telltale_wire_FleetRequest>> request_writer_;

  std::set<std::string> incomplete_;  ///< vehicles whose models may have a hole
  /// The newest revision of each vehicle at the start, until the other daemon has told its own.
  std::map<std::string, std::uint64_t> unconfirmed_;
  /// Vehicles of which earlier diagnoses may be missing: before which time. 0: any.
  std::map<std::string, double> diagnoses_before_;
  FleetRequest asked_;  ///< the request under way, of one vehicle; unknown: none
  Clock::time_point ask_again_;
};

}  // namespace telltale
