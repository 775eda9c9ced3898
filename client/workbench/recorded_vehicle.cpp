#include "telltale/client/workbench/recorded_vehicle.hpp"

#include <cstddef>
#include <string>
#include <utility>

#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/data/check/input_check.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

// ---- the vehicle that logs describe -------------------------------------------------------------

[[noreturn]] void AskForVehicle(const std::filesystem::path& silent) {
  throw UsageError("--vehicle is required: " + silent.string() +
                   " is a folder of CSV files, and only recordings of autopilots say how their "
                   "thrusters are driven");
}

}  // namespace

Vehicle DescribedVehicle(const RecordedLog& log) {
  if (!log.loaded.description) AskForVehicle(log.path);
  auto vehicle = VehicleFrom(*log.loaded.description, VehicleIdLike(log.path.stem().string()));
  if (vehicle) return *std::move(vehicle);
  Refusal refusal = std::move(vehicle).error();
  refusal.subject = log.path.string() + ' ' + refusal.subject;
  throw RefusedError(std::move(refusal));
}

namespace {

std::string RangeText(const PwmChannel& range) {
  return Plain(range.full_reverse_us) + " us (full reverse), " + Plain(range.neutral_us) +
         " us (neutral), " + Plain(range.full_forward_us) + " us (full forward)";
}

void NoteDescribed(const Vehicle& vehicle, const RecordedLog& log, const NoteSink& note) {
  const LogDescription& description = *log.loaded.description;
  note("vehicle " + vehicle.vehicle_id + " is taken from " + log.path.string() +
       ": port on channel " + std::to_string(description.port->channel) + ", " +
       RangeText(vehicle.port) + "; starboard on channel " +
       std::to_string(description.starboard->channel) + ", " + RangeText(vehicle.starboard) +
       "; the separation of the propellers and the antenna's place are unknown, taken as zero");
}

void RequireSameRange(const char* thruster, const PwmChannel& first, const PwmChannel& other,
                      const std::filesystem::path& first_log,
                      const std::filesystem::path& other_log) {
  if (first == other) return;
  throw RefusedError({other_log.string() + ' ' + thruster + " thruster",
                      "ranges over " + RangeText(other) + ", but over " + RangeText(first) +
                          " in " + first_log.string(),
                      "give a vehicle file that holds for all logs, or take the logs one by one"});
}

/// The first log's vehicle, to which all others must agree.
Vehicle DescribedBy(const std::vector<RecordedLog>& logs, const NoteSink& note) {
  const RecordedLog& first = logs.front();
  Vehicle vehicle = DescribedVehicle(first);
  for (std::size_t i = 1; i < logs.size(); ++i) {
    const Vehicle other = DescribedVehicle(logs[i]);
    RequireSameRange("port", vehicle.port, other.port, first.path, logs[i].path);
    RequireSameRange("starboard", vehicle.starboard, other.starboard, first.path, logs[i].path);
  }
  NoteDescribed(vehicle, first, note);
  return vehicle;
}

// ---- faults of input ----------------------------------------------------------------------------

std::vector<RecordingIdentity> IdentitiesOf(const std::vector<RecordedLog>& logs) {
  std::vector<RecordingIdentity> identities;
  for (const RecordedLog& log : logs) {
    identities.push_back(IdentityOf(log.loaded.recording, NameOf(log.path)));
  }
  return identities;
}

/// Data that count twice make bounds too narrow.
void RequireNotRepeated(const std::vector<RecordedLog>& logs,
                        const std::vector<RecordingIdentity>& identities) {
  if (logs.size() < 2) return;
  std::vector<FixMarks> marks;
  for (const RecordedLog& log : logs) marks.push_back(MarksOf(log.loaded.recording));
  for (std::size_t i = 1; i < logs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!Overlap(identities[i], marks[i], identities[j], marks[j])) continue;
      throw RefusedError({logs[i].path.string(),
                          "holds the same recording as " + logs[j].path.string(),
                          "give each recording once"});
    }
  }
}

void RequireSoundInput(const std::vector<RecordedLog>& logs) {
  for (const RecordedLog& log : logs) {
    if (!log.fault) continue;
    throw RefusedError(
        {log.path.string() + ' ' + log.fault->subject, log.fault->reason,
         log.fault->advice + "; --skip-input-check, if you know that the input is right"});
  }
}

}  // namespace

std::optional<Refusal> FaultAsRecorded(const RawChannels& recorded,
                                       const std::optional<LogDescription>& description,
                                       const std::optional<Vehicle>& stated) {
  std::optional<Vehicle> vehicle = stated;
  if (!vehicle && description) {
    if (auto described = VehicleFrom(*description, "log")) vehicle = *std::move(described);
  }
  if (!vehicle) return std::nullopt;
  return FirstFault(CheckInput(recorded.gnss, recorded.heading, recorded.thrusters, *vehicle));
}

void RequireSelfDescribing(const std::vector<std::filesystem::path>& logs) {
  for (const std::filesystem::path& log : logs) {
    if (FormatOf(log) == LogFormat::kTelemetryLog) AskForVehicle(log);
  }
}

RecordedVehicle Join(std::vector<RecordedLog> logs, std::optional<Vehicle> stated,
                     InputFaults faults, const NoteSink& note) {
  Vehicle vehicle = stated ? *std::move(stated) : DescribedBy(logs, note);
  std::vector<RecordingIdentity> identities = IdentitiesOf(logs);
  if (faults == InputFaults::kSought) {
    RequireNotRepeated(logs, identities);
    RequireSoundInput(logs);
  }
  std::vector<Recording> recordings;
  for (RecordedLog& log : logs) recordings.push_back(std::move(log.loaded.recording));
  return {Concatenate(std::move(recordings)), std::move(vehicle), std::move(identities)};
}

void NoteOtherVehicle(const Identification& model, const Vehicle& vehicle, const NoteSink& note) {
  if (model.vehicle_id == vehicle.vehicle_id) return;
  note("the model is of " + model.vehicle_id + ", the vehicle file of " + vehicle.vehicle_id);
}

}  // namespace telltale
