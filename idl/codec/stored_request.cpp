#include "telltale/idl/codec/stored_request.hpp"

#include <cmath>

#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"
#include "telltale/idl/proto/stored_request.pb.h"

namespace telltale {
namespace {

// Through the wire type, so that one codec knows the names and checks them.
void WriteKind(const IdentifyRequest& request, proto::StoredRequest& message) {
  const auto wire = Encode(request);
  proto::StoredRequest::Identify& kind = *message.mutable_identify();
  message.set_vehicle_id(request.vehicle_id);
  message.set_seed(request.seed);
  kind.set_structure(wire->structure);
  kind.set_parameterization(wire->parameterization);
  kind.set_estimator(wire->estimator);
  kind.set_preset(wire->preset);
  if (request.bootstrap_replicates) kind.set_bootstrap_replicates(*request.bootstrap_replicates);
  kind.set_dead_zone(wire->dead_zone);
  kind.set_dead_zone_forward(wire->dead_zone_forward);
  kind.set_dead_zone_reverse(wire->dead_zone_reverse);
  kind.set_include_reverse(wire->include_reverse);
  kind.set_resampling(wire->resampling);
  kind.set_interval_method(wire->interval_method);
  kind.set_coverage_check_replicates(wire->coverage_check_replicates);
  kind.set_recording_bias(wire->recording_bias);
}

void WriteKind(const DiagnoseRequest& request, proto::StoredRequest& message) {
  message.set_vehicle_id(request.vehicle_id);
  message.set_seed(request.seed);
  message.mutable_diagnose()->set_refit(request.refit);
  for (const std::string& effect : request.without) {
    message.mutable_diagnose()->add_without(effect);
  }
}

void WriteKind(const FleetRequest& request, proto::StoredRequest& message) {
  Require(request.command == FleetCommand::kRefresh, "a request for a refresh");
  const auto wire = Encode(request);
  proto::StoredRequest::Refresh& kind = *message.mutable_refresh();
  for (const std::string& id : request.vehicle_ids) kind.add_vehicle_ids(id);
  kind.set_all(request.all);
  kind.set_worse_than(wire->worse_than);
  kind.set_older_than_s(request.older_than_s);
}

/// A bounded string holds what fits; the codec refuses what is left as no identifier.
template <std::size_t n>
void PutBounded(char (&target)[n], const std::string& text) {
  wire::Put(target, std::string_view(text).substr(0, n - 1));
}

template <class Sample>
void PutIds(Sample& sample, const proto::StoredRequest& message) {
  wire::Put(sample->correlation_id, message.correlation_id());
  PutBounded(sample->vehicle_id, message.vehicle_id());
  sample->seed = message.seed();
}

Decoded<AnyRequest> ReadIdentify(const proto::StoredRequest& message) {
  WireSample<telltale_wire_IdentifyRequest> sample;
  const proto::StoredRequest::Identify& kind = message.identify();
  PutIds(sample, message);
  wire::Put(sample->structure, kind.structure());
  wire::Put(sample->parameterization, kind.parameterization());
  wire::Put(sample->estimator, kind.estimator());
  wire::Put(sample->preset, kind.preset());
  sample->bootstrap_given = kind.has_bootstrap_replicates();
  sample->bootstrap_replicates = kind.bootstrap_replicates();
  wire::Put(sample->dead_zone, kind.dead_zone());
  sample->dead_zone_forward = kind.dead_zone_forward();
  sample->dead_zone_reverse = kind.dead_zone_reverse();
  sample->include_reverse = kind.include_reverse();
  wire::Put(sample->resampling, kind.resampling());
  wire::Put(sample->interval_method, kind.interval_method());
  sample->coverage_check_replicates = kind.coverage_check_replicates();
  wire::Put(sample->recording_bias, kind.recording_bias());
  return Decode(*sample).map([](IdentifyRequest&& request) { return AnyRequest(request); });
}

Decoded<AnyRequest> ReadDiagnose(const proto::StoredRequest& message) {
  WireSample<telltale_wire_DiagnoseRequest> sample;
  PutIds(sample, message);
  sample->refit = message.diagnose().refit();
  wire::PutSequence(sample->without, message.diagnose().without(),
                    [](char*& element, const std::string& effect) { wire::Put(element, effect); });
  return Decode(*sample).map([](DiagnoseRequest&& request) { return AnyRequest(request); });
}

Decoded<AnyRequest> ReadRefresh(const proto::StoredRequest& message) {
  WireSample<telltale_wire_FleetRequest> sample;
  const proto::StoredRequest::Refresh& kind = message.refresh();
  wire::Put(sample->correlation_id, message.correlation_id());
  wire::Put(sample->command, Name(FleetCommand::kRefresh));
  wire::PutSequence(sample->vehicle_ids, kind.vehicle_ids(),
                    [](char*& element, const std::string& id) { wire::Put(element, id); });
  sample->all = kind.all();
  wire::Put(sample->worse_than, kind.worse_than());
  sample->older_than_s = kind.older_than_s();
  return Decode(*sample).map([](FleetRequest&& request) { return AnyRequest(request); });
}

Decoded<AnyRequest> ReadKind(const proto::StoredRequest& message) {
  switch (message.kind_case()) {
    case proto::StoredRequest::kIdentify: return ReadIdentify(message);
    case proto::StoredRequest::kDiagnose: return ReadDiagnose(message);
    case proto::StoredRequest::kRefresh: return ReadRefresh(message);
    case proto::StoredRequest::KIND_NOT_SET: break;
  }
  return tl::unexpected(CodecError{"kind", "", "a kind of request"});
}

}  // namespace

const std::string& CorrelationIdOf(const AnyRequest& request) {
  return std::visit([](const auto& kind) -> const std::string& { return kind.correlation_id; },
                    request);
}

std::string SerialiseRequest(const AnyRequest& request, double now_unix_s) {
  proto::StoredRequest message;
  std::visit(
      [&](const auto& kind) {
        message.set_correlation_id(kind.correlation_id);
        if (kind.deadline_s > 0.0) message.set_deadline_unix_s(now_unix_s + kind.deadline_s);
        WriteKind(kind, message);
      },
      request);
  return message.SerializeAsString();
}

Decoded<AnyRequest> ParseStoredRequest(std::string_view bytes, double now_unix_s) {
  proto::StoredRequest message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())) ||
      !std::isfinite(message.deadline_unix_s())) {
    return tl::unexpected(CodecError{"request", "bytes", "a stored request"});
  }
  auto request = ReadKind(message);
  if (request && message.deadline_unix_s() > 0.0) {
    std::visit([&](auto& kind) { kind.deadline_s = message.deadline_unix_s() - now_unix_s; },
               *request);
  }
  return request;
}

}  // namespace telltale
