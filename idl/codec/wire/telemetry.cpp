#include "telltale/idl/codec/wire/telemetry.hpp"

#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {
namespace {

template <class Wire, class Sample>
Wire WithHeader(const Telemetry<Sample>& telemetry) {
  Wire message{};
  wire::PutIdentifier(message.vehicle_id, telemetry.vehicle_id);
  message.sequence_number = telemetry.sequence_number;
  message.time_s = telemetry.sample.time_s;
  return message;
}

/// Decoding a valid sample neither allocates nor throws.
template <class Sample, class Wire>
Decoded<Telemetry<Sample>> DecodeTelemetry(const Wire& message, const Sample& sample) {
  const std::string_view vehicle_id = wire::View(message.vehicle_id);
  if (!IsVehicleId(vehicle_id)) {
    return tl::unexpected(wire::IdentifierError("vehicle_id", vehicle_id));
  }
  return Telemetry<Sample>{vehicle_id, message.sequence_number, sample};
}

}  // namespace

telltale_wire_GnssFix Encode(const Telemetry<GnssFix>& fix) {
  auto wire = WithHeader<telltale_wire_GnssFix>(fix);
  wire.latitude_deg = fix.sample.latitude_deg;
  wire.longitude_deg = fix.sample.longitude_deg;
  return wire;
}

telltale_wire_Heading Encode(const Telemetry<HeadingSample>& heading) {
  auto wire = WithHeader<telltale_wire_Heading>(heading);
  wire.heading_deg = heading.sample.heading_deg;
  return wire;
}

telltale_wire_Thrusters Encode(const Telemetry<ThrusterSample>& thrusters) {
  auto wire = WithHeader<telltale_wire_Thrusters>(thrusters);
  wire.left_us = thrusters.sample.port_us;
  wire.right_us = thrusters.sample.starboard_us;
  return wire;
}

Decoded<Telemetry<GnssFix>> Decode(const telltale_wire_GnssFix& wire) {
  return DecodeTelemetry(wire, GnssFix{wire.time_s, wire.latitude_deg, wire.longitude_deg});
}

Decoded<Telemetry<HeadingSample>> Decode(const telltale_wire_Heading& wire) {
  return DecodeTelemetry(wire, HeadingSample{wire.time_s, wire.heading_deg});
}

Decoded<Telemetry<ThrusterSample>> Decode(const telltale_wire_Thrusters& wire) {
  return DecodeTelemetry(wire, ThrusterSample{wire.time_s, wire.left_us, wire.right_us});
}

}  // namespace telltale
