#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "by_kind.hpp"
#include "insist.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/mapping_file.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

void InsistOnVehicle(std::string_view text) {
  const auto vehicle = ParseVehicle(text);
  if (!vehicle) return Insist(!vehicle.error().Message().empty());
  Insist(IsVehicleId(vehicle->vehicle_id));
  const std::string printed = PrintVehicle(*vehicle);
  const auto again = ParseVehicle(printed);
  Insist(again && PrintVehicle(*again) == printed);
}

/// Some of the ranges of daemon.proto, in numbers of their own.
void InsistOnConfiguration(std::string_view text) {
  const auto config = ParseDaemonConfig(text);
  if (!config) return Insist(!config.error().Message().empty());
  Insist(config->domain <= 101);
  Insist(config->window.duration_s >= 10.0 && config->window.duration_s <= 86400.0);
  Insist(config->identification.workers >= 1 && config->identification.workers <= 64);
  Insist(config->quality_period_s >= 0.1 && config->quality_period_s <= 3600.0);
  Insist(!config->slices || !config->database.empty());
  Insist(!config->workers || !config->database.empty());
  Insist(!config->standby || config->database.empty());
  Insist(!config->http || config->http->port <= 65535);
  Insist(!DuplicateVehicle(config->vehicles));
  for (const SourceSettings& source : config->sources) {
    Insist(source.mavlink.has_value() != source.ros2.has_value());
  }
}

void InsistOnMapping(std::string_view text) {
  const auto mapping = ParseMapping(text);
  Insist(mapping || !mapping.error().Message().empty());
}

void Run(std::uint8_t kind, Bytes bytes) {
  const std::string_view text = TextOf(bytes);
  switch (kind % 3) {
    case 0: return InsistOnVehicle(text);
    case 1: return InsistOnConfiguration(text);
    default: return InsistOnMapping(text);
  }
}

}  // namespace
}  // namespace telltale

/// What is refused says why, and what is taken keeps to its ranges. The first byte says which file
/// the others are.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telltale::InsistByKind(data, size, telltale::Run);
}
