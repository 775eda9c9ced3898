#pragma once

#include <string>
#include <string_view>

#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/vehicle.pb.h"

namespace telltale {

/// Vehicle file (Protobuf text format) -> Vehicle. `file` is only what errors call the text.
/// Refuses: unknown, missing and repeated fields, values out of the ranges of proto/vehicle.proto,
/// an id that is not 1..64 letters, digits, '.', '_' or '-', forward and reverse on one side of
/// neutral.
Decoded<Vehicle> ParseVehicle(std::string_view text, const std::string& file = "vehicle file");

/// Vehicle -> the text ParseVehicle reads back to the same vehicle.
std::string PrintVehicle(const Vehicle& vehicle);

proto::Vehicle ToProto(const Vehicle& vehicle);
Decoded<Vehicle> VehicleOf(const proto::Vehicle& message);

/// The same from a reader on a proto::Vehicle, for a file that holds vehicles among other things.
Vehicle ReadVehicle(FieldReader reader);

inline constexpr std::string_view kVehicleIdAllowed =
    "1..64 characters of letters, digits, '.', '_', '-'";
bool IsVehicleId(std::string_view text);

/// `text` with every other character replaced by '_', cut off at the longest length; "_" for none.
std::string VehicleIdLike(std::string_view text);

}  // namespace telltale
