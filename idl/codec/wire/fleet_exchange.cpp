#include "telltale/idl/codec/wire/fleet_exchange.hpp"

#include "telltale/idl/codec/wire/choices.hpp"
#include "telltale/idl/codec/wire/nested.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {
namespace wire {
namespace {

void FillVehicleSummary(telltale_wire_VehicleSummary& wire, const VehicleSummary& vehicle) {
  PutIdentifier(wire.vehicle_id, vehicle.vehicle_id);
  wire.window_s = vehicle.window_s;
  wire.window_fill = vehicle.window_fill;
  wire.revision = vehicle.revision;
  wire.model_age_s = vehicle.model_age_s;
  PutVerdict(wire.verdict, vehicle.promotion.verdict);
  Put(wire.verdict_reason, vehicle.promotion.reason);
}

VehicleSummary ReadVehicleSummary(const std::string& field,
                                  const telltale_wire_VehicleSummary& wire) {
  return {ReadIdentifier(field + ".vehicle_id", wire.vehicle_id),
          ReadWithin(field + ".window_s", wire.window_s, kFiniteNotNegative),
          ReadWithin(field + ".window_fill", wire.window_fill, kShare),
          wire.revision,
          ReadWithin(field + ".model_age_s", wire.model_age_s, kFinite),
          {ReadOptionalName(field + ".verdict", View(wire.verdict), kPromotionVerdicts),
           TextOf(wire.verdict_reason)}};
}

void FillModelSummary(telltale_wire_ModelSummary& wire, const ModelSummary& model) {
  wire.revision = model.revision;
  wire.published_unix_s = model.published_unix_s;
  Put(wire.structure, model.structure);
  Put(wire.estimator, model.estimator);
  wire.window_start_s = model.window_start_s;
  wire.window_end_s = model.window_end_s;
  wire.window_samples = model.window_samples;
  PutVerdict(wire.verdict, model.promotion.verdict);
  Put(wire.verdict_reason, model.promotion.reason);
}

ModelSummary ReadModelSummary(const std::string& field, const telltale_wire_ModelSummary& wire) {
  return {wire.revision,
          ReadWithin(field + ".published_unix_s", wire.published_unix_s, kFinite),
          TextOf(wire.structure),
          TextOf(wire.estimator),
          ReadWithin(field + ".window_start_s", wire.window_start_s, kFinite),
          ReadWithin(field + ".window_end_s", wire.window_end_s, kFinite),
          wire.window_samples,
          {ReadOptionalName(field + ".verdict", View(wire.verdict), kPromotionVerdicts),
           TextOf(wire.verdict_reason)}};
}

void FillRefreshed(telltale_wire_RefreshedVehicle& wire, const RefreshedVehicle& vehicle) {
  PutIdentifier(wire.vehicle_id, vehicle.vehicle_id);
  Put(wire.state, Name(vehicle.state));
  wire.revision = vehicle.revision;
  PutVerdict(wire.verdict, vehicle.verdict);
  Put(wire.reason, vehicle.reason);
}

RefreshedVehicle ReadRefreshed(const std::string& field,
                               const telltale_wire_RefreshedVehicle& wire) {
  return {ReadIdentifier(field + ".vehicle_id", wire.vehicle_id),
          ReadName(field + ".state", View(wire.state), kRefreshStates), wire.revision,
          ReadOptionalName(field + ".verdict", View(wire.verdict), kPromotionVerdicts),
          TextOf(wire.reason)};
}

std::string ReadOptionalIdentifier(const std::string& field, const auto& text) {
  return View(text).empty() ? std::string() : ReadIdentifier(field, text);
}

std::string ReadVehicleId(const std::string& field, const char* text) {
  return ReadIdentifier(field, text);
}

FleetRequest ReadFleetRequest(const telltale_wire_FleetRequest& wire) {
  FleetRequest request;
  request.correlation_id = ReadIdentifier("correlation_id", wire.correlation_id);
  request.command = ReadName("command", View(wire.command), kFleetCommands);
  request.vehicle_ids = ReadSequence("vehicle_ids", wire.vehicle_ids, ReadVehicleId);
  request.all = wire.all;
  request.revision = wire.revision;
  request.worse_than = ReadOptionalName("worse_than", View(wire.worse_than), kPromotionVerdicts);
  request.older_than_s = ReadWithin("older_than_s", wire.older_than_s, kFiniteNotNegative);
  request.target = ReadOptionalIdentifier("target", wire.target);
  request.deadline_s = ReadWithin("deadline_s", wire.deadline_s, kFiniteNotNegative);
  request.before_unix_s = ReadWithin("before_unix_s", wire.before_unix_s, kFiniteNotNegative);
  return request;
}

FleetProgress ReadFleetProgress(const telltale_wire_FleetProgress& wire) {
  return {ReadIdentifier("correlation_id", wire.correlation_id), wire.total,
          ReadSequence("vehicles", wire.vehicles, ReadRefreshed)};
}

PublishedModel ReadLaterModel(const std::string&, const telltale_wire_Model& wire) {
  return ReadModel(wire);
}

PublishedDiagnosis ReadEarlierDiagnosis(const std::string&, const telltale_wire_Diagnosis& wire) {
  return ReadDiagnosis(wire);
}

FleetReply ReadFleetReply(const telltale_wire_FleetReply& wire) {
  return {{ReadIdentifier("correlation_id", wire.correlation_id), "",
           ReadName("outcome", View(wire.outcome), kReplyOutcomes), TextOf(wire.message),
           ReadSequence("refusals", wire.refusals, ReadRefusal),
           ReadWithin("elapsed_s", wire.elapsed_s, kFiniteNotNegative),
           ReadWithin("retry_after_s", wire.retry_after_s, kFiniteNotNegative)},
          ReadSequence("vehicles", wire.vehicles, ReadVehicleSummary),
          ReadSequence("models", wire.models, ReadModelSummary),
          ReadSequence("refreshed", wire.refreshed, ReadRefreshed),
          ReadSequence("later_models", wire.later_models, ReadLaterModel),
          ReadSequence("earlier_diagnoses", wire.earlier_diagnoses, ReadEarlierDiagnosis),
          wire.slices};
}

}  // namespace
}  // namespace wire

WireSample<telltale_wire_FleetRequest> Encode(const FleetRequest& request) {
  WireSample<telltale_wire_FleetRequest> sample;
  wire::PutIdentifier(sample->correlation_id, request.correlation_id);
  wire::Put(sample->command, Name(request.command));
  wire::PutSequence(sample->vehicle_ids, request.vehicle_ids,
                    [](char*& element, const std::string& id) { wire::Put(element, id); });
  sample->all = request.all;
  sample->revision = request.revision;
  wire::PutVerdict(sample->worse_than, request.worse_than);
  sample->older_than_s = request.older_than_s;
  wire::Put(sample->target, request.target);
  sample->deadline_s = request.deadline_s;
  sample->before_unix_s = request.before_unix_s;
  return sample;
}

WireSample<telltale_wire_FleetProgress> Encode(const FleetProgress& progress) {
  WireSample<telltale_wire_FleetProgress> sample;
  wire::PutIdentifier(sample->correlation_id, progress.correlation_id);
  sample->total = progress.total;
  wire::PutSequence(sample->vehicles, progress.vehicles, wire::FillRefreshed);
  return sample;
}

WireSample<telltale_wire_FleetReply> Encode(const FleetReply& reply) {
  WireSample<telltale_wire_FleetReply> sample;
  wire::PutIdentifier(sample->correlation_id, reply.correlation_id);
  wire::Put(sample->outcome, Name(reply.outcome));
  wire::Put(sample->message, reply.message);
  wire::PutSequence(sample->refusals, reply.refusals, wire::FillRefusal);
  wire::PutSequence(sample->vehicles, reply.vehicles, wire::FillVehicleSummary);
  wire::PutSequence(sample->models, reply.models, wire::FillModelSummary);
  wire::PutSequence(sample->refreshed, reply.refreshed, wire::FillRefreshed);
  sample->elapsed_s = reply.elapsed_s;
  sample->retry_after_s = reply.retry_after_s;
  wire::PutSequence(sample->later_models, reply.later_models, wire::FillModel);
  wire::PutSequence(sample->earlier_diagnoses, reply.earlier_diagnoses, wire::FillDiagnosis);
  sample->slices = reply.slices;
  return sample;
}

Decoded<FleetRequest> Decode(const telltale_wire_FleetRequest& wire) {
  return wire::Guarded([&] { return wire::ReadFleetRequest(wire); });
}

Decoded<FleetProgress> Decode(const telltale_wire_FleetProgress& wire) {
  return wire::Guarded([&] { return wire::ReadFleetProgress(wire); });
}

Decoded<FleetReply> Decode(const telltale_wire_FleetReply& wire) {
  return wire::Guarded([&] { return wire::ReadFleetReply(wire); });
}

}  // namespace telltale
