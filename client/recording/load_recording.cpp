#include "telltale/client/recording/load_recording.hpp"

#include <utility>

#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"

namespace telltale {
namespace {

Result<RawLog> FromFolder(const std::filesystem::path& folder) {
  return ReadTelemetryLog(folder).map([](TelemetryLog log) {
    return RawLog{std::move(log.samples), log.malformed, std::nullopt};
  });
}

Result<RawLog> FromFile(const std::filesystem::path& file, const DataFlashOptions& options) {
  return ReadDataFlash(file, options).map([](DataFlashLog log) {
    // Thruster samples exist, so both outputs are known.
    return RawLog{InOrderOfTime(log.gnss, log.heading, log.thrusters),
                  {},
                  DataFlashSource{std::move(log.report), *log.port, *log.starboard}};
  });
}

Result<PwmChannel> RangeOf(const ThrusterOutput& output, const char* thruster) {
  if (output.range) return *output.range;
  return Refuse(std::string(thruster) + " thruster", output.range_fault, "give a vehicle file");
}

}  // namespace

Result<RawLog> ReadLog(const std::filesystem::path& path, const DataFlashOptions& options) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) ? FromFolder(path) : FromFile(path, options);
}

Result<LoadedRecording> LoadRecording(const std::filesystem::path& path,
                                      const DataFlashOptions& options) {
  auto log = ReadLog(path, options);
  if (!log) return tl::unexpected(std::move(log).error());
  auto admitted = Admit(log->samples);
  if (!admitted) {
    Refusal refusal = std::move(admitted).error();
    refusal.subject = path.string() + " " + refusal.subject;
    return tl::unexpected(std::move(refusal));
  }
  return LoadedRecording{std::move(admitted->recording), admitted->evicted, log->malformed,
                         std::move(log->dataflash)};
}

Result<Vehicle> VehicleFrom(const DataFlashSource& source, const std::string& vehicle_id) {
  const auto port = RangeOf(source.port, "port");
  if (!port) return tl::unexpected(port.error());
  const auto starboard = RangeOf(source.starboard, "starboard");
  if (!starboard) return tl::unexpected(starboard.error());
  Vehicle vehicle;
  vehicle.vehicle_id = vehicle_id;
  vehicle.port = *port;
  vehicle.starboard = *starboard;
  return vehicle;
}

}  // namespace telltale
