#include "telltale/idl/codec/vehicle_file.hpp"

#include <algorithm>
#include <cctype>
#include <functional>

#include "telltale/idl/codec/text_message.hpp"

namespace telltale {
namespace {

constexpr std::size_t kLongestVehicleId = 64;
constexpr FieldRange kSeparation{0.05, 50.0};
constexpr FieldRange kNeutral{800.0, 2200.0};
constexpr FieldRange kFullCommand{500.0, 2500.0};
constexpr FieldRange kLeverArm{-100.0, 100.0};
constexpr FieldRange kMass{0.0, 100000.0, true};
constexpr FieldRange kLength{0.2, 100.0};
constexpr FieldRange kBeam{0.1, 50.0};
constexpr FieldRange kDraught{0.01, 20.0};
constexpr FieldRange kArea{0.001, 1000.0};

bool IsOfVehicleId(unsigned char c) {
  return c < 0x80 && (std::isalnum(c) || c == '.' || c == '_' || c == '-');
}

PwmChannel ReadChannel(FieldReader reader) {
  PwmChannel channel;
  channel.neutral_us = reader.Number("neutral_us", kNeutral);
  channel.full_forward_us = reader.Number("full_forward_us", kFullCommand);
  channel.full_reverse_us = reader.Number("full_reverse_us", kFullCommand);
  const double forward_span = channel.full_forward_us - channel.neutral_us;
  const double reverse_span = channel.full_reverse_us - channel.neutral_us;
  if (forward_span == 0.0) {
    reader.Fail("full_forward_us", NumberText(channel.full_forward_us),
                "other than neutral_us = " + NumberText(channel.neutral_us));
  }
  if (!(forward_span * reverse_span < 0.0)) {
    reader.Fail("full_reverse_us", NumberText(channel.full_reverse_us),
                "on the other side of neutral_us = " + NumberText(channel.neutral_us) +
                    " than full_forward_us = " + NumberText(channel.full_forward_us));
  }
  return channel;
}

LeverArm ReadLeverArm(FieldReader reader) {
  return {reader.Number("forward_m", kLeverArm), reader.Number("starboard_m", kLeverArm)};
}

HullParticulars ReadHull(FieldReader reader) {
  HullParticulars hull;
  const auto read = [&](const char* field, const FieldRange& range, double& value) {
    if (reader.Has(field)) value = reader.Number(field, range);
  };
  read("length_m", kLength, hull.length_m);
  read("beam_m", kBeam, hull.beam_m);
  read("draught_m", kDraught, hull.draught_m);
  read("frontal_area_m2", kArea, hull.frontal_area_m2);
  read("lateral_area_m2", kArea, hull.lateral_area_m2);
  return hull;
}

void WriteHull(const HullParticulars& hull, proto::Vehicle::Hull& message) {
  message.set_length_m(hull.length_m);
  message.set_beam_m(hull.beam_m);
  message.set_draught_m(hull.draught_m);
  message.set_frontal_area_m2(hull.frontal_area_m2);
  message.set_lateral_area_m2(hull.lateral_area_m2);
}

void WriteChannel(const PwmChannel& channel, proto::Vehicle::PwmChannel& message) {
  message.set_neutral_us(channel.neutral_us);
  message.set_full_forward_us(channel.full_forward_us);
  message.set_full_reverse_us(channel.full_reverse_us);
}

}  // namespace

bool IsVehicleId(std::string_view text) {
  return !text.empty() && text.size() <= kLongestVehicleId &&
         std::all_of(text.begin(), text.end(), IsOfVehicleId);
}

std::string VehicleIdLike(std::string_view text) {
  std::string id(text.substr(0, kLongestVehicleId));
  std::replace_if(id.begin(), id.end(), std::not_fn(IsOfVehicleId), '_');
  return id.empty() ? "_" : id;
}

Vehicle ReadVehicle(FieldReader reader) {
  Vehicle vehicle;
  vehicle.vehicle_id = reader.Text("vehicle_id");
  if (!IsVehicleId(vehicle.vehicle_id)) {
    reader.Fail("vehicle_id", '"' + vehicle.vehicle_id + '"', std::string(kVehicleIdAllowed));
  }
  vehicle.propeller_separation_m = reader.Number("propeller_separation_m", kSeparation);
  vehicle.port = ReadChannel(reader.Required("port"));
  vehicle.starboard = ReadChannel(reader.Required("starboard"));
  vehicle.gnss_antenna = ReadLeverArm(reader.Optional("gnss_antenna"));
  if (reader.Has("mass_kg")) vehicle.mass_kg = reader.Number("mass_kg", kMass);
  if (reader.Has("hull")) vehicle.hull = ReadHull(reader.Required("hull"));
  return vehicle;
}

Decoded<Vehicle> ParseVehicle(std::string_view text, const std::string& file) {
  proto::Vehicle message;
  google::protobuf::TextFormat::ParseInfoTree lines;
  std::optional<CodecError> fault = ParseTextMessage(text, file, message, lines);
  if (fault) return tl::unexpected(*fault);
  const FieldSource source{file, FieldSource::Names::kProto, &lines};
  Vehicle vehicle = ReadVehicle(FieldReader(message, source, fault));
  if (fault) return tl::unexpected(*fault);
  return vehicle;
}

Decoded<Vehicle> VehicleOf(const proto::Vehicle& message) {
  const FieldSource source;
  std::optional<CodecError> fault;
  Vehicle vehicle = ReadVehicle(FieldReader(message, source, fault));
  if (fault) return tl::unexpected(*fault);
  return vehicle;
}

proto::Vehicle ToProto(const Vehicle& vehicle) {
  proto::Vehicle message;
  message.set_vehicle_id(vehicle.vehicle_id);
  message.set_propeller_separation_m(vehicle.propeller_separation_m);
  WriteChannel(vehicle.port, *message.mutable_port());
  WriteChannel(vehicle.starboard, *message.mutable_starboard());
  message.mutable_gnss_antenna()->set_forward_m(vehicle.gnss_antenna.forward_m);
  message.mutable_gnss_antenna()->set_starboard_m(vehicle.gnss_antenna.starboard_m);
  if (vehicle.mass_kg) message.set_mass_kg(*vehicle.mass_kg);
  if (vehicle.hull) WriteHull(*vehicle.hull, *message.mutable_hull());
  return message;
}

std::string PrintVehicle(const Vehicle& vehicle) {
  std::string text;
  google::protobuf::TextFormat::PrintToString(ToProto(vehicle), &text);
  return text;
}

}  // namespace telltale
