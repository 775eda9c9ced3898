#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "bus_type.hpp"
#include "by_kind.hpp"
#include "insist.hpp"
#include "telltale/idl/codec/json/metrics.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/idl/codec/wire/daemon_status.hpp"
#include "telltale/idl/codec/wire/diagnosis.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/idl/codec/wire/quality.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"
#include "telltale/idl/codec/wire/vehicle_announcement.hpp"

namespace telltale {
namespace {

/// What is refused says why, and what is taken is printed as text that reads back to the same.
template <class Parse, class Print>
void InsistOnText(std::string_view text, Parse parse, Print print) {
  const auto read = parse(text);
  if (!read) return Insist(!read.error().Message().empty());
  const std::string printed = print(*read);
  const auto again = parse(printed);
  Insist(again && print(*again) == printed);
}

/// The same of the bytes of a message.
template <class Message, class Read>
void InsistOnMessage(Bytes bytes, Read read_message) {
  Message message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
  const auto read = read_message(message);
  if (!read) return Insist(!read.error().Message().empty());
  const auto again = read_message(ToProto(*read));
  Insist(again && ToProto(*again).SerializeAsString() == ToProto(*read).SerializeAsString());
}

/// The same of a sample from the bus.
template <class Wire>
void InsistOnSample(Bytes bytes) {
  const auto& type = BusType<Wire>::Instance();
  type.Read(bytes, [&](const Wire& wire) {
    const auto read = Decode(wire);
    if (!read) return Insist(!read.error().Message().empty());
    const std::string written = type.Write(Encode(*read));
    Insist(type.Read(Bytes(reinterpret_cast<const std::uint8_t*>(written.data()), written.size()),
                     [&](const Wire& again) {
                       const auto same = Decode(again);
                       Insist(same && type.Write(Encode(*same)) == written);
                     }));
  });
}

/// Telemetry is written by others alone.
template <class Wire>
void InsistOnTelemetry(Bytes bytes) {
  BusType<Wire>::Instance().Read(bytes, [&](const Wire& wire) {
    const auto read = Decode(wire);
    Insist(read || !read.error().Message().empty());
  });
}

void Run(std::uint8_t kind, Bytes bytes) {
  const std::string_view text = TextOf(bytes);
  switch (kind % 19) {
    case 0:
      return InsistOnText(
          text, [](auto t) { return ParseModelJson(t); }, PrintModelJson);
    case 1:
      return InsistOnText(
          text, [](auto t) { return ParseReportJson(t); }, PrintReportJson);
    case 2:
      return InsistOnMessage<proto::Model>(bytes,
                                           [](const auto& m) { return IdentificationOf(m); });
    case 3:
      return InsistOnMessage<proto::Report>(bytes, [](const auto& m) { return DiagnosisOf(m); });
    case 4:
      return InsistOnText(
          text, [](auto t) { return ParseMetricsJson(t); }, PrintMetricsJson);
    case 5: return InsistOnSample<telltale_wire_Model>(bytes);
    case 6: return InsistOnSample<telltale_wire_Diagnosis>(bytes);
    case 7: return InsistOnSample<telltale_wire_Quality>(bytes);
    case 8: return InsistOnSample<telltale_wire_IdentifyReply>(bytes);
    case 9: return InsistOnSample<telltale_wire_IdentifyProgress>(bytes);
    case 10: return InsistOnSample<telltale_wire_DiagnoseReply>(bytes);
    case 11: return InsistOnSample<telltale_wire_DiagnoseProgress>(bytes);
    case 12: return InsistOnSample<telltale_wire_FleetReply>(bytes);
    case 13: return InsistOnSample<telltale_wire_FleetProgress>(bytes);
    case 14: return InsistOnSample<telltale_wire_DaemonStatus>(bytes);
    case 15: return InsistOnTelemetry<telltale_wire_GnssFix>(bytes);
    case 16: return InsistOnTelemetry<telltale_wire_Heading>(bytes);
    case 17: return InsistOnSample<telltale_wire_VehicleAnnouncement>(bytes);
    default: return InsistOnTelemetry<telltale_wire_Thrusters>(bytes);
  }
}

}  // namespace
}  // namespace telltale

/// The first byte says as what the others arrive: as JSON, as a message, or as a sample on the bus.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telltale::InsistByKind(data, size, telltale::Run);
}
