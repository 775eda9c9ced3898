#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "bus_type.hpp"
#include "by_kind.hpp"
#include "insist.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/stored_request.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"
#include "telltale/idl/proto/fleet.pb.h"
#include "telltale/service/tasks/identification_options.hpp"

namespace telltale {
namespace {

/// A request that the daemon can keep on disk.
template <class Request>
void InsistOnKeeping(const Request& request) {
  constexpr double kNow = 1e9;
  Insist(IsVehicleId(request.correlation_id));
  const auto kept = ParseStoredRequest(SerialiseRequest(request, kNow), kNow);
  Insist(kept && CorrelationIdOf(*kept) == request.correlation_id);
}

/// Options out of their range are refused in words, and nothing else happens to them.
void InsistOn(const IdentifyRequest& request) {
  InsistOnKeeping(request);
  const auto fault = OptionsOf(request, IdentificationSettings()).Validate();
  Insist(!fault || !fault->reason.empty());
}

void InsistOn(const DiagnoseRequest& request) {
  InsistOnKeeping(request);
}

void InsistOn(const FleetRequest& request) {
  if (request.command == FleetCommand::kRefresh) InsistOnKeeping(request);
}

template <class Wire>
void InsistOnSample(Bytes bytes) {
  BusType<Wire>::Instance().Read(bytes, [](const Wire& wire) {
    const auto request = Decode(wire);
    request ? InsistOn(*request) : Insist(!request.error().Message().empty());
  });
}

/// What the HTTP API takes as an order.
template <class Order>
void InsistOnBody(Bytes bytes) {
  Order order;
  const std::string_view body = TextOf(bytes);
  const auto fault = ParseJsonMessage(body, "body", order);
  Insist(!fault || !fault->Message().empty());
}

void Run(std::uint8_t kind, Bytes bytes) {
  switch (kind % 5) {
    case 0: return InsistOnSample<telltale_wire_IdentifyRequest>(bytes);
    case 1: return InsistOnSample<telltale_wire_DiagnoseRequest>(bytes);
    case 2: return InsistOnSample<telltale_wire_FleetRequest>(bytes);
    case 3: return InsistOnBody<proto::Order>(bytes);
    default: return InsistOnBody<proto::RollbackOrder>(bytes);
  }
}

}  // namespace
}  // namespace telltale

/// The first byte says as what the others arrive: as a request on the bus, or as one over HTTP.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telltale::InsistByKind(data, size, telltale::Run);
}
