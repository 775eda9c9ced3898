#include "telltale/service/workers/heavy_job_codec.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/json/provenance.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/idl/codec/stored_request.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/proto/heavy_job.pb.h"
#include "telltale/service/storage/packed_blob.hpp"
#include "telltale/service/windows/window_chunk.hpp"

namespace telltale {
namespace {

template <class Message>
std::string Pack(const Message& message) {
  return PackBlob(message.SerializeAsString());
}

template <class Message>
bool Unpack(std::string_view blob, Message& message) {
  const auto bytes = UnpackBlob(blob);
  return bytes && message.ParseFromString(*bytes);
}

template <class Request>
void WriteRequest(Request request, proto::HeavyTask& message) {
  request.deadline_s = 0.0;
  message.mutable_request()->ParseFromString(SerialiseRequest(request, 0.0));
}

void WriteSamples(const Recording& recording, proto::HeavyTask::Samples& message) {
  *message.mutable_channels() = ToProto(recording);
  for (const double start_s : recording.starts_s) message.add_starts_s(start_s);
}

std::optional<Recording> ReadSamples(const proto::HeavyTask::Samples& message) {
  auto recording = RecordingOf(message.channels());
  if (recording) {
    recording->starts_s.assign(message.starts_s().begin(), message.starts_s().end());
  }
  return recording;
}

tl::unexpected<CodecError> Fault(std::string field, std::string value, std::string allowed) {
  return tl::unexpected(CodecError{std::move(field), std::move(value), std::move(allowed)});
}

/// The request and the vehicle that every task has.
template <class Task, class Request>
Decoded<Task> ReadCommon(const proto::HeavyTask& message) {
  const auto request = ParseStoredRequest(message.request().SerializeAsString(), 0.0);
  if (!request) return tl::unexpected(request.error());
  const auto* of_kind = std::get_if<Request>(&*request);
  if (of_kind == nullptr) return Fault("request", "another", "one of the task's kind");
  auto vehicle = VehicleOf(message.vehicle());
  if (!vehicle) return tl::unexpected(vehicle.error());
  Task task;
  task.request = *of_kind;
  task.vehicle = *std::move(vehicle);
  return task;
}

Decoded<HeavyTask> ReadIdentify(const proto::HeavyTask& message) {
  auto task = ReadCommon<IdentificationTask, IdentifyRequest>(message);
  if (!task) return tl::unexpected(task.error());
  const proto::HeavyTask::Identify& kind = message.identify();
  auto recording = ReadSamples(kind.recording());
  if (!recording) return Fault("recording", "", "lists of one length in each channel");
  task->recording = *std::move(recording);
  task->settings.bootstrap_replicates = kind.bootstrap_replicates();
  task->settings.interval_level = kind.interval_level();
  if (kind.structure() != 0) task->settings.structure = EnumCast<Structure>(kind.structure());
  return HeavyTask(*std::move(task));
}

Decoded<HeavyTask> ReadDiagnose(const proto::HeavyTask& message) {
  auto task = ReadCommon<DiagnosisTask, DiagnoseRequest>(message);
  if (!task) return tl::unexpected(task.error());
  const proto::HeavyTask::Diagnose& kind = message.diagnose();
  auto model = IdentificationOf(kind.model(), "model");
  if (!model) return tl::unexpected(model.error());
  task->model = *std::move(model);
  auto since = ReadSamples(kind.since());
  if (!since) return Fault("since", "", "lists of one length in each channel");
  task->since = *std::move(since);
  if (kind.has_baseline()) {
    task->baseline = ReadSamples(kind.baseline());
    if (!task->baseline) return Fault("baseline", "", "lists of one length in each channel");
  }
  return HeavyTask(*std::move(task));
}

std::string PackRefusal(const Refusal& refusal) {
  proto::HeavyOutcome message;
  *message.mutable_refused() = ToProto(refusal);
  return Pack(message);
}

/// Throws where it holds no result; the kind is the caller's to check.
proto::HeavyOutcome OutcomeIn(std::string_view blob) {
  proto::HeavyOutcome message;
  if (!Unpack(blob, message)) throw std::runtime_error("the answer of the worker is damaged");
  if (message.has_failed()) throw std::runtime_error(message.failed());
  return message;
}

Refusal RefusalIn(const proto::Refusal& message) {
  return {message.subject(), message.reason(), message.advice()};
}

template <class T>
T Whole(Decoded<T> decoded) {
  if (!decoded) {
    throw std::runtime_error("the answer of the worker cannot be read: " +
                             decoded.error().Message());
  }
  return *std::move(decoded);
}

}  // namespace

std::string PackTask(const IdentificationTask& task) {
  proto::HeavyTask message;
  WriteRequest(task.request, message);
  *message.mutable_vehicle() = ToProto(task.vehicle);
  proto::HeavyTask::Identify& kind = *message.mutable_identify();
  WriteSamples(task.recording, *kind.mutable_recording());
  if (task.settings.structure) {
    kind.set_structure(EnumCast<proto::Structure>(*task.settings.structure));
  }
  kind.set_bootstrap_replicates(task.settings.bootstrap_replicates);
  kind.set_interval_level(task.settings.interval_level);
  return Pack(message);
}

std::string PackTask(const DiagnosisTask& task) {
  proto::HeavyTask message;
  WriteRequest(task.request, message);
  *message.mutable_vehicle() = ToProto(task.vehicle);
  proto::HeavyTask::Diagnose& kind = *message.mutable_diagnose();
  *kind.mutable_model() = ToProto(task.model);
  WriteSamples(task.since, *kind.mutable_since());
  if (task.baseline) WriteSamples(*task.baseline, *kind.mutable_baseline());
  return Pack(message);
}

Decoded<HeavyTask> UnpackTask(std::string_view blob) {
  proto::HeavyTask message;
  if (!Unpack(blob, message)) return Fault("task", "bytes", "a task with its checksum");
  switch (message.kind_case()) {
    case proto::HeavyTask::kIdentify: return ReadIdentify(message);
    case proto::HeavyTask::kDiagnose: return ReadDiagnose(message);
    case proto::HeavyTask::KIND_NOT_SET: break;
  }
  return Fault("kind", "", "a kind of task");
}

std::string PackOutcome(const Result<AssessedModel>& outcome) {
  if (!outcome) return PackRefusal(outcome.error());
  proto::HeavyOutcome message;
  proto::HeavyOutcome::Identified& identified = *message.mutable_identified();
  *identified.mutable_model() = ToProto(outcome->identification);
  identified.set_verdict(std::string(Name(outcome->promotion.verdict)));
  identified.set_verdict_reason(outcome->promotion.reason);
  if (outcome->reference_error) {
    for (const double error : *outcome->reference_error) identified.add_reference_error(error);
  }
  return Pack(message);
}

std::string PackOutcome(const Result<DiagnosedModel>& outcome) {
  if (!outcome) return PackRefusal(outcome.error());
  proto::HeavyOutcome message;
  proto::HeavyOutcome::Diagnosed& diagnosed = *message.mutable_diagnosed();
  *diagnosed.mutable_report() = ToProto(outcome->diagnosis);
  if (outcome->augmented) *diagnosed.mutable_augmented() = ToProto(*outcome->augmented);
  return Pack(message);
}

std::string PackFailure(std::string_view failed) {
  proto::HeavyOutcome message;
  message.set_failed(std::string(failed));
  return Pack(message);
}

Result<AssessedModel> UnpackOutcome(std::string_view blob, const IdentificationTask&) {
  const proto::HeavyOutcome message = OutcomeIn(blob);
  if (message.has_refused()) return tl::unexpected(RefusalIn(message.refused()));
  const proto::HeavyOutcome::Identified& identified = message.identified();
  AssessedModel model;
  model.identification = Whole(IdentificationOf(identified.model(), "model"));
  model.promotion = {PromotionVerdictNamed(identified.verdict()), identified.verdict_reason()};
  if (identified.reference_error_size() == 3) {
    model.reference_error = {identified.reference_error(0), identified.reference_error(1),
                             identified.reference_error(2)};
  }
  return model;
}

Result<DiagnosedModel> UnpackOutcome(std::string_view blob, const DiagnosisTask&) {
  const proto::HeavyOutcome message = OutcomeIn(blob);
  if (message.has_refused()) return tl::unexpected(RefusalIn(message.refused()));
  const proto::HeavyOutcome::Diagnosed& diagnosed = message.diagnosed();
  DiagnosedModel model;
  model.diagnosis = Whole(DiagnosisOf(diagnosed.report(), "report"));
  if (diagnosed.has_augmented()) {
    model.augmented = Whole(IdentificationOf(diagnosed.augmented(), "augmented"));
  }
  return model;
}

}  // namespace telltale
