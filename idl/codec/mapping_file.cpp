#include "telltale/idl/codec/mapping_file.hpp"

#include <array>
#include <span>

#include "telltale/core/base/degrees.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/text_message.hpp"
#include "telltale/idl/proto/mapping.pb.h"

namespace telltale {
namespace {

constexpr FieldRange kHeadingOffset{-360.0, 360.0};
constexpr double kStamp = 0.0;       // in place of a unit
constexpr double kQuaternion = 0.0;  // likewise

struct MappedUnit {
  std::string_view name;
  double factor;
};
constexpr std::array kTimeUnits = {MappedUnit{"s", 1.0}, MappedUnit{"ms", 1e-3},
                                   MappedUnit{"us", 1e-6}, MappedUnit{"ns", 1e-9},
                                   MappedUnit{"stamp", kStamp}};
constexpr std::array kPositionUnits = {MappedUnit{"deg", 1.0}, MappedUnit{"rad", kDegreesPerRadian},
                                       MappedUnit{"1e-7 deg", 1e-7}};
constexpr std::array kHeadingUnits = {MappedUnit{"deg", 1.0}, MappedUnit{"rad", kDegreesPerRadian},
                                      MappedUnit{"0.01 deg", 1e-2},
                                      MappedUnit{"quaternion", kQuaternion}};
constexpr std::array kFrames = {MappedUnit{"NED", 0.0}, MappedUnit{"ENU", 1.0}};
constexpr double kPulse = 0.0;
constexpr double kNewtons = -1.0;
constexpr std::array kCommandUnits = {MappedUnit{"us", kPulse}, MappedUnit{"share", 1.0},
                                      MappedUnit{"percent", 100.0}, MappedUnit{"N", kNewtons}};

double UnitOf(FieldReader& reader, std::string_view field, std::span<const MappedUnit> units) {
  const std::string name = reader.Text(field, units.front().name);
  std::string allowed;
  for (const MappedUnit& unit : units) {
    if (unit.name == name) return unit.factor;
    allowed.append(allowed.empty() ? "" : ", ").append(unit.name);
  }
  reader.Fail(field, Quoted(name), "one of " + allowed);
  return units.front().factor;
}

std::string NameOf(FieldReader& reader, std::string_view field) {
  std::string name = reader.Text(field);
  if (name.empty()) reader.Fail(field, "\"\"", "the name of a field or column");
  return name;
}

MappedTime ReadTime(FieldReader& parent, const MappedTime& otherwise) {
  if (!parent.Has("time")) return otherwise;
  FieldReader reader = parent.Required("time");
  MappedTime time;
  time.field = NameOf(reader, "field");
  time.unit_s = UnitOf(reader, "unit", kTimeUnits);
  time.is_stamp = time.unit_s == kStamp;
  return time;
}

MappedPositions ReadPositions(FieldReader reader, const MappedTime& time) {
  MappedPositions positions;
  positions.topic = reader.Text("topic", "");
  positions.time = ReadTime(reader, time);
  positions.is_metres = reader.Has("north") || reader.Has("east");
  if (positions.is_metres) {
    for (const char* field : {"latitude", "longitude", "unit"}) {
      if (reader.Has(field)) reader.Fail(field, "given", "absent beside north and east, in metres");
    }
  }
  positions.latitude = NameOf(reader, positions.is_metres ? "north" : "latitude");
  positions.longitude = NameOf(reader, positions.is_metres ? "east" : "longitude");
  if (!positions.is_metres) positions.unit_deg = UnitOf(reader, "unit", kPositionUnits);
  return positions;
}

MappedHeadings ReadHeadings(FieldReader reader, const MappedTime& time) {
  MappedHeadings headings;
  headings.topic = reader.Text("topic", "");
  headings.time = ReadTime(reader, time);
  headings.field = NameOf(reader, "field");
  headings.unit_deg = UnitOf(reader, "unit", kHeadingUnits);
  headings.is_quaternion = headings.unit_deg == kQuaternion;
  headings.is_east_north_up = UnitOf(reader, "frame", kFrames) > 0.0;
  headings.offset_deg = reader.Number("offset_deg", kHeadingOffset, 0.0);
  return headings;
}

MappedThruster ReadThruster(FieldReader reader, const MappedTime& time) {
  MappedThruster thruster;
  thruster.topic = reader.Text("topic", "");
  thruster.time = ReadTime(reader, time);
  thruster.field = NameOf(reader, "field");
  const double full = UnitOf(reader, "unit", kCommandUnits);
  thruster.is_pulse = full == kPulse;
  if (thruster.is_pulse) {
    if (reader.Has("full_forward") || reader.Has("full_reverse")) {
      reader.Fail("full_forward", "given", "absent with unit us: the vehicle file holds it");
    }
    return thruster;
  }
  if (full == kNewtons) {
    thruster.full_forward = reader.Number("full_forward", kFinite);
    thruster.full_reverse = reader.Number("full_reverse", kFinite);
  } else {
    thruster.full_forward = reader.Number("full_forward", kFinite, full);
    thruster.full_reverse = reader.Number("full_reverse", kFinite, -full);
  }
  if (!(thruster.full_forward * thruster.full_reverse < 0.0)) {
    reader.Fail("full_reverse", NumberText(thruster.full_reverse),
                "of the other sign than full_forward = " + NumberText(thruster.full_forward));
  }
  return thruster;
}

}  // namespace

Decoded<Mapping> ParseMapping(std::string_view text, const std::string& file) {
  proto::Mapping message;
  google::protobuf::TextFormat::ParseInfoTree lines;
  std::optional<CodecError> fault = ParseTextMessage(text, file, message, lines);
  if (fault) return tl::unexpected(*fault);
  const FieldSource source{file, FieldSource::Names::kProto, &lines};
  FieldReader reader(message, source, fault);
  Mapping mapping;
  mapping.name = reader.Text("name", file);
  const MappedTime time = ReadTime(reader, {});
  mapping.positions = ReadPositions(reader.Required("positions"), time);
  mapping.positions.held = message.positions().held();
  mapping.headings = ReadHeadings(reader.Required("headings"), time);
  mapping.headings.held = message.headings().held();
  mapping.port = ReadThruster(reader.Required("port"), time);
  mapping.starboard = ReadThruster(reader.Required("starboard"), time);
  if (fault) return tl::unexpected(*fault);
  return mapping;
}

}  // namespace telltale
