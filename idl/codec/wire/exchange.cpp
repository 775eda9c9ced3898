#include "telltale/idl/codec/wire/exchange.hpp"

#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/codec/wire/choices.hpp"
#include "telltale/idl/codec/wire/nested.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {
namespace wire {
namespace {

/// Puts an empty name for the unknown enumerator.
void PutChoice(char*& target, auto value) {
  Put(target, value == decltype(value)::kUnknown ? std::string_view() : Name(value));
}

void FillRequest(telltale_wire_IdentifyRequest& wire, const IdentifyRequest& request) {
  PutIdentifier(wire.correlation_id, request.correlation_id);
  PutIdentifier(wire.vehicle_id, request.vehicle_id);
  PutChoice(wire.structure, request.structure);
  PutChoice(wire.parameterization, request.parameterization);
  PutChoice(wire.estimator, request.estimator);
  PutChoice(wire.preset, request.preset);
  wire.bootstrap_given = request.bootstrap_replicates.has_value();
  wire.bootstrap_replicates = request.bootstrap_replicates.value_or(0);
  wire.seed = request.seed;
  PutChoice(wire.dead_zone, request.dead_zone_source);
  wire.dead_zone_forward = request.dead_zone.forward;
  wire.dead_zone_reverse = request.dead_zone.reverse;
  wire.include_reverse = request.include_reverse;
  PutChoice(wire.resampling, request.resampling);
  PutChoice(wire.interval_method, request.interval_method);
  wire.coverage_check_replicates = request.coverage_check_replicates;
  PutChoice(wire.recording_bias, request.recording_bias);
  wire.deadline_s = request.deadline_s;
}

void FillRequest(telltale_wire_DiagnoseRequest& wire, const DiagnoseRequest& request) {
  PutIdentifier(wire.correlation_id, request.correlation_id);
  PutIdentifier(wire.vehicle_id, request.vehicle_id);
  wire.refit = request.refit;
  PutSequence(wire.without, request.without,
              [](char*& element, const std::string& effect) { Put(element, effect); });
  wire.seed = request.seed;
  wire.deadline_s = request.deadline_s;
}

void FillProgress(auto& wire, const ExchangeProgress& progress) {
  PutIdentifier(wire.correlation_id, progress.correlation_id);
  PutIdentifier(wire.vehicle_id, progress.vehicle_id);
  Put(wire.stage, progress.stage);
  wire.fraction = progress.fraction;
}

void FillReply(auto& wire, const ExchangeReply& reply) {
  PutIdentifier(wire.correlation_id, reply.correlation_id);
  PutIdentifier(wire.vehicle_id, reply.vehicle_id);
  Put(wire.outcome, Name(reply.outcome));
  Put(wire.message, reply.message);
  PutSequence(wire.refusals, reply.refusals, FillRefusal);
  wire.elapsed_s = reply.elapsed_s;
  wire.retry_after_s = reply.retry_after_s;
}

void FillAugmented(telltale_wire_Model& wire, const Identification& augmented) {
  FillModel(wire, PublishedModel{augmented, 0, 0.0});
}

IdentifyRequest ReadRequest(const telltale_wire_IdentifyRequest& wire) {
  IdentifyRequest request;
  request.correlation_id = ReadIdentifier("correlation_id", wire.correlation_id);
  request.vehicle_id = ReadIdentifier("vehicle_id", wire.vehicle_id);
  request.structure = ReadOptionalName("structure", View(wire.structure), kStructures);
  request.parameterization =
      ReadOptionalName("parameterization", View(wire.parameterization), kParameterizations);
  request.estimator = ReadOptionalName("estimator", View(wire.estimator), kEstimators);
  request.preset = ReadOptionalName("preset", View(wire.preset), kPresets);
  if (wire.bootstrap_given) request.bootstrap_replicates = wire.bootstrap_replicates;
  request.seed = wire.seed;
  request.dead_zone_source = ReadOptionalName("dead_zone", View(wire.dead_zone), kDeadZoneSources);
  request.dead_zone = ReadDeadZone(wire.dead_zone_forward, wire.dead_zone_reverse);
  request.include_reverse = wire.include_reverse;
  request.resampling = ReadOptionalName("resampling", View(wire.resampling), kResamplings);
  request.interval_method =
      ReadOptionalName("interval_method", View(wire.interval_method), kIntervalMethods);
  request.coverage_check_replicates = wire.coverage_check_replicates;
  request.recording_bias =
      ReadOptionalName("recording_bias", View(wire.recording_bias), kRecordingBiasModels);
  request.deadline_s = ReadWithin("deadline_s", wire.deadline_s, kFiniteNotNegative);
  return request;
}

/// Effects are named of the characters of identifiers. Other text could not be kept with the
/// request, since Protobuf reads no strings but UTF-8.
std::string ReadEffectName(const std::string& field, const char* effect) {
  std::string name = TextOf(effect);
  if (!IsVehicleId(name)) Reject(field, std::move(name), "an effect of the library");
  return name;
}

DiagnoseRequest ReadRequest(const telltale_wire_DiagnoseRequest& wire) {
  DiagnoseRequest request;
  request.correlation_id = ReadIdentifier("correlation_id", wire.correlation_id);
  request.vehicle_id = ReadIdentifier("vehicle_id", wire.vehicle_id);
  request.refit = wire.refit;
  request.without = ReadSequence("without", wire.without, ReadEffectName);
  request.seed = wire.seed;
  request.deadline_s = ReadWithin("deadline_s", wire.deadline_s, kFiniteNotNegative);
  return request;
}

ExchangeProgress ReadProgress(const auto& wire) {
  return {ReadIdentifier("correlation_id", wire.correlation_id),
          ReadIdentifier("vehicle_id", wire.vehicle_id), TextOf(wire.stage),
          ReadWithin("fraction", wire.fraction, kShare)};
}

ExchangeReply ReadReply(const auto& wire) {
  return {ReadIdentifier("correlation_id", wire.correlation_id),
          ReadIdentifier("vehicle_id", wire.vehicle_id),
          ReadName("outcome", View(wire.outcome), kReplyOutcomes),
          TextOf(wire.message),
          ReadSequence("refusals", wire.refusals, ReadRefusal),
          ReadWithin("elapsed_s", wire.elapsed_s, kFiniteNotNegative),
          ReadWithin("retry_after_s", wire.retry_after_s, kFiniteNotNegative)};
}

/// Whether the reply has a result to read. Refuses a published reply without one and any other
/// reply with one.
bool HasResult(const char* field, const auto& result, const ExchangeReply& reply) {
  const bool published = reply.outcome == ReplyOutcome::kPublished;
  if (result._length != (published ? 1u : 0u)) {
    Reject(field, std::to_string(result._length) + " items",
           published ? "one when published" : "none unless published");
  }
  return published;
}

/// None where no effect is likely, and from writers whose type lacks the field.
std::optional<Identification> ReadAugmented(const dds_sequence_telltale_wire_Model& wire,
                                            const DiagnoseReply& reply) {
  const std::uint32_t most = reply.diagnosis ? 1 : 0;
  if (wire._length > most) {
    Reject("augmented", std::to_string(wire._length) + " items",
           most > 0 ? "none or one" : "none unless published");
  }
  if (wire._length == 0) return std::nullopt;
  Identification augmented = ReadModel(wire._buffer[0]).identification;
  if (augmented.vehicle_id != reply.vehicle_id) {
    Reject("augmented[0].vehicle_id", augmented.vehicle_id, "the reply's, " + reply.vehicle_id);
  }
  return augmented;
}

IdentifyReply ReadIdentifyReply(const telltale_wire_IdentifyReply& wire) {
  IdentifyReply reply{ReadReply(wire), {}};
  if (HasResult("model", wire.model, reply)) reply.model = ReadModel(wire.model._buffer[0]);
  return reply;
}

DiagnoseReply ReadDiagnoseReply(const telltale_wire_DiagnoseReply& wire) {
  DiagnoseReply reply{ReadReply(wire), {}, {}};
  if (HasResult("diagnosis", wire.diagnosis, reply)) {
    reply.diagnosis = ReadDiagnosis(wire.diagnosis._buffer[0]);
  }
  reply.augmented = ReadAugmented(wire.augmented, reply);
  return reply;
}

}  // namespace
}  // namespace wire

WireSample<telltale_wire_IdentifyRequest> Encode(const IdentifyRequest& request) {
  WireSample<telltale_wire_IdentifyRequest> sample;
  wire::FillRequest(*sample, request);
  return sample;
}

WireSample<telltale_wire_IdentifyProgress> Encode(const IdentifyProgress& progress) {
  WireSample<telltale_wire_IdentifyProgress> sample;
  wire::FillProgress(*sample, progress);
  return sample;
}

WireSample<telltale_wire_IdentifyReply> Encode(const IdentifyReply& reply) {
  WireSample<telltale_wire_IdentifyReply> sample;
  wire::FillReply(*sample, reply);
  sample->revision = reply.model ? reply.model->revision : 0;
  wire::PutOptional(sample->model, reply.model, wire::FillModel);
  return sample;
}

WireSample<telltale_wire_DiagnoseRequest> Encode(const DiagnoseRequest& request) {
  WireSample<telltale_wire_DiagnoseRequest> sample;
  wire::FillRequest(*sample, request);
  return sample;
}

WireSample<telltale_wire_DiagnoseProgress> Encode(const DiagnoseProgress& progress) {
  WireSample<telltale_wire_DiagnoseProgress> sample;
  wire::FillProgress(*sample, progress);
  return sample;
}

WireSample<telltale_wire_DiagnoseReply> Encode(const DiagnoseReply& reply) {
  WireSample<telltale_wire_DiagnoseReply> sample;
  wire::FillReply(*sample, reply);
  wire::PutOptional(sample->diagnosis, reply.diagnosis, wire::FillDiagnosis);
  wire::PutOptional(sample->augmented, reply.augmented, wire::FillAugmented);
  return sample;
}

Decoded<IdentifyRequest> Decode(const telltale_wire_IdentifyRequest& wire) {
  return wire::Guarded([&] { return wire::ReadRequest(wire); });
}

Decoded<IdentifyProgress> Decode(const telltale_wire_IdentifyProgress& wire) {
  return wire::Guarded([&] { return IdentifyProgress{wire::ReadProgress(wire)}; });
}

Decoded<IdentifyReply> Decode(const telltale_wire_IdentifyReply& wire) {
  return wire::Guarded([&] { return wire::ReadIdentifyReply(wire); });
}

Decoded<DiagnoseRequest> Decode(const telltale_wire_DiagnoseRequest& wire) {
  return wire::Guarded([&] { return wire::ReadRequest(wire); });
}

Decoded<DiagnoseProgress> Decode(const telltale_wire_DiagnoseProgress& wire) {
  return wire::Guarded([&] { return DiagnoseProgress{wire::ReadProgress(wire)}; });
}

Decoded<DiagnoseReply> Decode(const telltale_wire_DiagnoseReply& wire) {
  return wire::Guarded([&] { return wire::ReadDiagnoseReply(wire); });
}

}  // namespace telltale
