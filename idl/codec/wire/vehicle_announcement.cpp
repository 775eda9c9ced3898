#include "telltale/idl/codec/wire/vehicle_announcement.hpp"

#include <string>
#include <utility>

#include <boost/locale/utf.hpp>

#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {
namespace {

bool IsControl(boost::locale::utf::code_point c) {
  const bool is_white = c == '\t' || c == '\n' || c == '\r';
  return (c < ' ' && !is_white) || (c >= 0x7f && c < 0xa0);
}

/// A log that shows part of it shows no more than text.
bool IsText(std::string_view bytes) {
  for (const char* next = bytes.begin(); next != bytes.end();) {
    const auto c = boost::locale::utf::utf_traits<char>::decode(next, bytes.end());
    if (!boost::locale::utf::is_valid_codepoint(c) || IsControl(c)) return false;
  }
  return true;
}

tl::unexpected<AnnouncementFault> Fault(AnnouncementFaultReason reason, CodecError error) {
  return tl::unexpected(AnnouncementFault{reason, std::move(error)});
}

}  // namespace

std::string_view Name(AnnouncementFaultReason reason) {
  switch (reason) {
    case AnnouncementFaultReason::kMalformedId: return "MALFORMED_VEHICLE_ID";
    case AnnouncementFaultReason::kTooLarge: return "TOO_LARGE";
    case AnnouncementFaultReason::kNotText: return "NOT_TEXT";
    case AnnouncementFaultReason::kNotVehicleFile: return "NOT_A_VEHICLE_FILE";
    case AnnouncementFaultReason::kOtherId: return "OTHER_VEHICLE_ID";
  }
  return "";
}

WireSample<telltale_wire_VehicleAnnouncement> Encode(const Vehicle& vehicle) {
  auto wire = EncodeRetired(vehicle.vehicle_id);
  dds_string_free(wire->vehicle_file);
  wire::Put(wire->vehicle_file, PrintVehicle(vehicle));
  return wire;
}

WireSample<telltale_wire_VehicleAnnouncement> EncodeRetired(std::string_view vehicle_id) {
  WireSample<telltale_wire_VehicleAnnouncement> wire;
  wire::PutIdentifier(wire->vehicle_id, vehicle_id);
  wire::Put(wire->vehicle_file, "");
  return wire;
}

Decoded<std::string> AnnouncedId(const telltale_wire_VehicleAnnouncement& wire) {
  return wire::Guarded([&] { return wire::ReadIdentifier("vehicle_id", wire.vehicle_id); });
}

tl::expected<Vehicle, AnnouncementFault> Decode(const telltale_wire_VehicleAnnouncement& wire) {
  using enum AnnouncementFaultReason;
  auto id = AnnouncedId(wire);
  if (!id) return Fault(kMalformedId, std::move(id).error());
  const std::string_view text = wire::View(wire.vehicle_file);
  if (text.size() > kLargestVehicleFile) {
    return Fault(kTooLarge, {"vehicle_file", std::to_string(text.size()) + " bytes",
                             "at most " + std::to_string(kLargestVehicleFile) + " bytes", *id});
  }
  if (!IsText(text)) {
    return Fault(kNotText, {"vehicle_file", std::to_string(text.size()) + " bytes",
                            "UTF-8 without control characters", *id});
  }
  auto vehicle = ParseVehicle(text, "announcement of " + *id);
  if (!vehicle) return Fault(kNotVehicleFile, std::move(vehicle).error());
  if (vehicle->vehicle_id != *id) {
    return Fault(kOtherId, {"vehicle_id", vehicle->vehicle_id, "that of the key, " + *id});
  }
  return *std::move(vehicle);
}

}  // namespace telltale
