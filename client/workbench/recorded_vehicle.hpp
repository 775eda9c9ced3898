#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "telltale/client/workbench/note_sink.hpp"
#include "telltale/client/workbench/recorded_log.hpp"
#include "telltale/core/data/recording_identity.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// One recording, the vehicle that made it and the logs that it is of.
struct RecordedVehicle {
  Recording recording;
  Vehicle vehicle;
  std::vector<RecordingIdentity> logs;
};

/// Whether faults of input are sought before logs are joined.
enum class InputFaults { kSought, kIgnored };

/// The first fault of input that channels show as they were recorded: admission drops what is
/// repeated, and with it the sign of a stuck channel. The vehicle is as stated, or else as the log
/// describes it. Nothing where neither is there.
std::optional<Refusal> FaultAsRecorded(const RawChannels& recorded,
                                       const std::optional<LogDescription>& description,
                                       const std::optional<Vehicle>& stated);

/// Throws: UsageError naming the first log that is of a format which describes no vehicle. It
/// spares whoever states no vehicle to read logs in vain.
void RequireSelfDescribing(const std::vector<std::filesystem::path>& logs);

/// The vehicle that a log describes. Throws: UsageError where it is of a format that describes
/// none, RefusedError where it lacks a thruster or its range.
Vehicle DescribedVehicle(const RecordedLog& log);

/// One recording of all logs, put one after the other (Concatenate), and the vehicle: as stated, or
/// else the first log's DescribedVehicle, with a note on what was taken for it. Throws: UsageError
/// where neither is there; RefusedError naming the log, where logs describe different vehicles,
/// and, unless kIgnored, where a log repeats another or has a fault of input. Requires: at least
/// one log.
RecordedVehicle Join(std::vector<RecordedLog> logs, std::optional<Vehicle> stated,
                     InputFaults faults, const NoteSink& note);

/// NoteSink when a model was identified on another vehicle.
void NoteOtherVehicle(const Identification& model, const Vehicle& vehicle, const NoteSink& note);

}  // namespace telltale
