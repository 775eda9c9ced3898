#include "telltale/service/standby/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/idl/codec/wire/diagnosis.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/service/models/free_run_error.hpp"

namespace telltale {
namespace {

// Between the end of a window and the end of the identification that it goes into.
constexpr double kJustMadeWithinS = 30.0;

// More than a daemon publishes in the instant of its death, and less than kModelsAtATime.
constexpr std::uint64_t kUnheardAtMost = 8;

template <class Message, class Keep>
void KeepOrLog(const Decoded<Message>& message, const char* what, Keep keep) {
  if (!message) {
    spdlog::warn("another daemon's {} cannot be read: {}", what, message.error().Message());
    return;
  }
  try {
    keep(*message);
  } catch (const std::exception& error) {
    spdlog::error("another daemon's {} is not kept: {}", what, error.what());
  }
}

}  // namespace

Mirror::Mirror(const Participant& participant, WaitSet& wait_set, const Role& role,
               const Into& into)
    : participant_(participant),
      wait_set_(wait_set),
      role_(role),
      into_(into),
      model_reader_(participant, FromOthers(ModelQos())),
      diagnosis_reader_(participant, FromOthers(DiagnosisQos())),
      reply_reader_(participant, FromOthers(RequestReplyQos())) {
  for (const auto& [vehicle_id, window] : into.fleet.windows()) {
    incomplete_.insert(vehicle_id);
    diagnoses_before_.emplace(vehicle_id, 0.0);
    if (const auto latest = into.models.Latest(vehicle_id)) {
      unconfirmed_.emplace(vehicle_id, latest->model.revision);
    }
  }
  wait_set_.Attach(model_reader_, [this] {
    model_reader_.Take([this](const telltale_wire_Model& wire) { Take(wire); });
  });
  wait_set_.Attach(diagnosis_reader_, [this] {
    diagnosis_reader_.Take([this](const telltale_wire_Diagnosis& wire) { Take(wire); });
  });
  wait_set_.Attach(reply_reader_, [this] {
    reply_reader_.Take([this](const telltale_wire_FleetReply& wire) {
      const auto reply = Decode(wire);
      if (reply && reply->correlation_id == asked_.correlation_id && !role_.Serves()) Take(*reply);
    });
  });
}

Mirror::~Mirror() {
  wait_set_.Detach(reply_reader_);
  wait_set_.Detach(model_reader_);
  wait_set_.Detach(diagnosis_reader_);
}

void Mirror::Take(const telltale_wire_Model& wire) {
  KeepOrLog(Decode(wire), "model", [this](const PublishedModel& model) { Keep({model, {}}); });
}

void Mirror::Take(const telltale_wire_Diagnosis& wire) {
  if (role_.Serves()) return;
  KeepOrLog(Decode(wire), "diagnosis", [this](const PublishedDiagnosis& diagnosis) {
    into_.diagnoses.Learn(diagnosis);
    diagnoses_before_.emplace(diagnosis.diagnosis.vehicle_id, diagnosis.published_unix_s);
  });
}

void Mirror::FillHoles(Clock::time_point now) {
  if (asked_.command != FleetCommand::kUnknown && now < ask_again_) return;
  asked_ = {};
  while (!incomplete_.empty()) {
    const std::string vehicle_id = *incomplete_.begin();
    if (const auto after = MissingAfter(vehicle_id)) {
      FleetRequest request;
      request.command = FleetCommand::kModels;
      request.revision = *after;
      return Ask(std::move(request), vehicle_id, now);
    }
    incomplete_.erase(vehicle_id);
  }
  if (!diagnoses_before_.empty()) {
    const auto& [vehicle_id, before_unix_s] = *diagnoses_before_.begin();
    FleetRequest request;
    request.command = FleetCommand::kDiagnoses;
    request.before_unix_s = before_unix_s;
    return Ask(std::move(request), vehicle_id, now);
  }
  request_writer_.reset();
}

/// The revision after which models are to be asked for; nothing where all of the vehicle are kept.
std::optional<std::uint64_t> Mirror::MissingAfter(const std::string& vehicle_id) const {
  const auto own = unconfirmed_.find(vehicle_id);
  if (own == unconfirmed_.end()) return into_.models.HoleAfter(vehicle_id);
  return own->second - std::min(own->second, kUnheardAtMost);
}

/// Not yet where the writer is not connected.
void Mirror::Ask(FleetRequest request, const std::string& vehicle_id, Clock::time_point now) {
  constexpr std::chrono::seconds kPatience{5};
  if (!request_writer_) request_writer_.emplace(participant_, FromOthers(RequestReplyQos()));
  if (request_writer_->Matched() == 0) return;
  request.correlation_id = NewCorrelationId();
  request.vehicle_ids = {vehicle_id};
  request.deadline_s = std::chrono::duration<double>(kPatience).count();
  request_writer_->Write(Encode(request));
  asked_ = std::move(request);
  ask_again_ = now + kPatience;
}

/// A busy daemon is asked again.
void Mirror::Take(const FleetReply& reply) {
  if (reply.retry_after_s > 0.0) return;
  asked_.command == FleetCommand::kModels ? TakeModels(reply) : TakeDiagnoses(reply);
  asked_ = {};
}

/// What the other daemon does not have either is not asked for again.
void Mirror::TakeModels(const FleetReply& reply) {
  const std::string& vehicle_id = asked_.vehicle_ids.front();
  const bool confirms = unconfirmed_.erase(vehicle_id) > 0;
  const auto before = into_.models.HoleAfter(vehicle_id);
  for (const PublishedModel& model : reply.later_models) {
    KeepOrLog(Decoded<PublishedModel>(model), "model",
              [this](const PublishedModel& earlier) { into_.models.LearnEarlier(earlier); });
  }
  const auto after = into_.models.HoleAfter(vehicle_id);
  if (after && (confirms || after != before)) return;
  incomplete_.erase(vehicle_id);
  spdlog::info("the models of {} are as complete as those of the daemon that serves", vehicle_id);
}

/// An answer that brings nothing new is the last.
void Mirror::TakeDiagnoses(const FleetReply& reply) {
  const std::string& vehicle_id = asked_.vehicle_ids.front();
  bool brings_new = false;
  for (const PublishedDiagnosis& diagnosis : reply.earlier_diagnoses) {
    KeepOrLog(Decoded<PublishedDiagnosis>(diagnosis), "diagnosis",
              [&](const PublishedDiagnosis& earlier) {
                brings_new |= into_.diagnoses.LearnEarlier(earlier);
              });
    diagnoses_before_[vehicle_id] = diagnosis.published_unix_s;
  }
  if (brings_new) return;
  diagnoses_before_.erase(vehicle_id);
  spdlog::info("the diagnoses of {} are as complete as those of the daemon that serves",
               vehicle_id);
}

void Mirror::Keep(StoredModel model) {
  incomplete_.insert(model.model.identification.vehicle_id);
  const Identification& identification = model.model.identification;
  VehicleWindow* const window = into_.fleet.Find(identification.vehicle_id);
  const bool just_made =
      window != nullptr &&
      std::abs(window->State().end_s - identification.window.end_s) < kJustMadeWithinS;
  if (!just_made) return into_.models.Learn(model);
  Recording recording = window->Snapshot();
  model.reference_error = MeasureFreeRunError(recording, window->vehicle(), identification);
  into_.models.Learn(model);
  into_.baselines.Keep(identification.vehicle_id, model.model.revision, std::move(recording));
}

}  // namespace telltale
