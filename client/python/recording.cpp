#include "telltale/client/python/recording.hpp"

#include <algorithm>
#include <utility>

#include "telltale/client/python/bindings.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

// ---- where recordings come from -----------------------------------------------------------------

void RequireValid(const SourceOptions& options) {
  if (const auto refusal = options.Validate()) {
    throw UsageError(refusal->subject + ": " + refusal->reason + "; " + refusal->advice);
  }
}

void Take(RawLog raw, const fs::path& path, StatedLog& log) {
  log.recorded = raw.channels;
  log.log =
      Admitted(path, std::move(raw), [&](const std::string& note) { log.notes.push_back(note); });
}

std::shared_ptr<StatedLog> Load(const fs::path& path, const std::optional<VehicleOrFile>& vehicle,
                                const std::optional<fs::path>& mapping,
                                std::optional<int> gps_instance, std::optional<int> system_id,
                                std::optional<int> port_channel,
                                std::optional<int> starboard_channel) {
  RequireThere(path);
  SourceOptions options;
  options.gps_instance = gps_instance;
  options.system_id = system_id;
  options.port_channel = port_channel;
  options.starboard_channel = starboard_channel;
  RequireValid(options);
  if (mapping) {
    RequireThere(*mapping);
    options.mapping = LoadMapping(*mapping);
  }
  auto loaded = std::make_shared<StatedLog>();
  loaded->stated = VehicleOf(vehicle);
  const py::gil_scoped_release unlocked;
  Take(LoadAsRecorded(path, options), path, *loaded);
  return loaded;
}

std::vector<GnssFix> FixesAt(const std::vector<double>& time_s, const Numbers& latitude_deg,
                             const Numbers& longitude_deg) {
  const auto latitudes = ColumnOf("latitude_deg", latitude_deg, time_s.size());
  const auto longitudes = ColumnOf("longitude_deg", longitude_deg, time_s.size());
  std::vector<GnssFix> fixes;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    fixes.push_back({time_s[i], latitudes[i], longitudes[i]});
  }
  return fixes;
}

std::vector<HeadingSample> HeadingsAt(const std::vector<double>& time_s, const Numbers& values) {
  const auto heading_deg = ColumnOf("heading_deg", values, time_s.size());
  std::vector<HeadingSample> headings;
  for (std::size_t i = 0; i < time_s.size(); ++i) headings.push_back({time_s[i], heading_deg[i]});
  return headings;
}

std::vector<ThrusterSample> PulsesAt(const std::vector<double>& time_s, const Numbers& port,
                                     const Numbers& starboard) {
  const auto port_us = ColumnOf("port_us", port, time_s.size());
  const auto starboard_us = ColumnOf("starboard_us", starboard, time_s.size());
  std::vector<ThrusterSample> pulses;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    pulses.push_back({time_s[i], port_us[i], starboard_us[i]});
  }
  return pulses;
}

std::shared_ptr<StatedLog> FromArrays(const VehicleOrFile& vehicle, const Numbers& fix_time_s,
                                      const Numbers& latitude_deg, const Numbers& longitude_deg,
                                      const Numbers& heading_time_s, const Numbers& heading_deg,
                                      const Numbers& command_time_s, const Numbers& port_us,
                                      const Numbers& starboard_us, const std::string& name) {
  RawLog raw;
  raw.channels = {FixesAt(ColumnOf("fix_time_s", fix_time_s), latitude_deg, longitude_deg),
                  HeadingsAt(ColumnOf("heading_time_s", heading_time_s), heading_deg),
                  PulsesAt(ColumnOf("command_time_s", command_time_s), port_us, starboard_us)};
  auto made = std::make_shared<StatedLog>();
  made->stated = VehicleOf(vehicle);
  Take(std::move(raw), name, *made);
  return made;
}

// ---- what they hold -----------------------------------------------------------------------------

const Recording& SamplesOf(const StatedLog& log) {
  return log.log.loaded.recording;
}

/// Metres from the first fix.
std::vector<NorthEastPosition> PositionsOf(const StatedLog& log) {
  const std::vector<GnssFix>& fixes = SamplesOf(log).gnss;
  const NorthEastFrame frame({fixes.front().latitude_deg, fixes.front().longitude_deg});
  std::vector<NorthEastPosition> positions;
  for (const GnssFix& fix : fixes) {
    positions.push_back(frame.Forward({fix.latitude_deg, fix.longitude_deg}));
  }
  return positions;
}

py::array_t<double> RecordedCommands(const StatedLog& log) {
  const Vehicle vehicle = log.stated ? *log.stated : DescribedVehicle(log.log);
  const auto& pulses = SamplesOf(log).thrusters;
  return CommandArrayOf(pulses, [&](const ThrusterSample& pulse) {
    return vehicle.Normalise(pulse.port_us, pulse.starboard_us);
  });
}

py::dict RejectedOf(const StatedLog& log) {
  py::dict rejected;
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      const auto count = SamplesOf(log).rejected.Of(channel, reason);
      if (count == 0) continue;
      rejected[py::str(std::string(Name(channel)) + ' ' + std::string(Name(reason)))] = count;
    }
  }
  return rejected;
}

std::string RecordingText(const StatedLog& log) {
  const Recording& recording = SamplesOf(log);
  return "<telltale.Recording " + NameOf(log.log.path) + ": " +
         std::to_string(recording.gnss.size()) + " fixes, " +
         std::to_string(recording.heading.size()) + " headings, " +
         std::to_string(recording.thrusters.size()) + " commands>";
}

/// A property: one field of the samples of one channel.
template <class Sample>
auto Field(std::vector<Sample> Recording::*channel, double Sample::*field) {
  return [channel, field](const StatedLog& log) { return ArrayOf(SamplesOf(log).*channel, field); };
}

auto Field(double NorthEastPosition::*field) {
  return [field](const StatedLog& log) { return ArrayOf(PositionsOf(log), field); };
}

using RecordingClass = py::class_<StatedLog, std::shared_ptr<StatedLog>>;

void AddConstruction(RecordingClass& recording) {
  recording.def_static(
      "from_arrays", &FromArrays, py::kw_only(), py::arg("vehicle"), py::arg("fix_time_s"),
      py::arg("latitude_deg"), py::arg("longitude_deg"), py::arg("heading_time_s"),
      py::arg("heading_deg"), py::arg("command_time_s"), py::arg("port_us"),
      py::arg("starboard_us"), py::arg("name") = "recording",
      "A recording of arrays, checked like one of a file.\n\n"
      "Args:\n"
      "    vehicle: a Vehicle, or the path of a vehicle file.\n"
      "    fix_time_s, latitude_deg, longitude_deg: positions of the antenna, WGS84.\n"
      "    heading_time_s, heading_deg: true headings, clockwise from north.\n"
      "    command_time_s, port_us, starboard_us: pulse widths sent to the thrusters.\n"
      "    name: by which errors and models name the recording.\n\n"
      "Raises InputError where arrays do not fit together, DataCannotTell where nothing "
      "of a channel can be trusted.");
}

void AddOrigin(RecordingClass& recording) {
  recording
      .def_property_readonly(
          "name", [](const StatedLog& log) { return NameOf(log.log.path); },
          "The last part of the path, or the name that from_arrays was given.")
      .def_property_readonly("vehicle", &StatedLog::KnownVehicle,
                             "As stated, or as the log describes it; else None.")
      .def_readonly("notes", &StatedLog::notes,
                    "What was read, and what was left out, as sentences.")
      .def_property_readonly("rejected", &RejectedOf,
                             "Samples that cannot be trusted, counted by channel and reason.");
}

void AddChannels(RecordingClass& recording) {
  recording
      .def_property_readonly("fix_time_s", Field(&Recording::gnss, &GnssFix::time_s),
                             "Times of the positions.")
      .def_property_readonly("latitude_deg", Field(&Recording::gnss, &GnssFix::latitude_deg),
                             "WGS84.")
      .def_property_readonly("longitude_deg", Field(&Recording::gnss, &GnssFix::longitude_deg),
                             "WGS84.")
      .def_property_readonly("north_m", Field(&NorthEastPosition::north_m),
                             "Positions from the first fix.")
      .def_property_readonly("east_m", Field(&NorthEastPosition::east_m),
                             "Positions from the first fix.")
      .def_property_readonly("heading_time_s", Field(&Recording::heading, &HeadingSample::time_s),
                             "Times of the headings.")
      .def_property_readonly("heading_deg", Field(&Recording::heading, &HeadingSample::heading_deg),
                             "True headings, clockwise from north, as recorded.")
      .def_property_readonly("command_time_s",
                             Field(&Recording::thrusters, &ThrusterSample::time_s),
                             "Times of the commands.")
      .def_property_readonly("port_us", Field(&Recording::thrusters, &ThrusterSample::port_us),
                             "Pulse widths of the port thruster.")
      .def_property_readonly("starboard_us",
                             Field(&Recording::thrusters, &ThrusterSample::starboard_us),
                             "Pulse widths of the starboard thruster.")
      .def_property_readonly("commands", &RecordedCommands,
                             "Commands in shares of full command, [-1, 1], a row each, port first. "
                             "Raises InputError where the vehicle is not known.");
}

}  // namespace

std::optional<Vehicle> StatedLog::KnownVehicle() const {
  if (stated || !log.loaded.description) return stated;
  return OptionalOf(VehicleFrom(*log.loaded.description, VehicleIdLike(log.path.stem().string())));
}

Recordings ListOf(const OneOrMore& recordings) {
  Recordings list;
  if (const auto* several = std::get_if<Recordings>(&recordings)) {
    list = *several;
  } else {
    list = {std::get<std::shared_ptr<StatedLog>>(recordings)};
  }
  if (list.empty()) throw UsageError("recordings: give one at least");
  RequireEach("recordings", list);
  return list;
}

void RequireEach(const char* argument, const Recordings& recordings) {
  if (std::ranges::count(recordings, nullptr) == 0) return;
  throw UsageError(std::string(argument) + ": None is no recording; give what load returns");
}

RecordedVehicle Joined(const Recordings& recordings, const std::optional<VehicleOrFile>& vehicle,
                       InputFaults faults) {
  std::optional<Vehicle> stated = VehicleOf(vehicle);
  std::vector<RecordedLog> logs;
  for (const auto& recording : recordings) {
    logs.push_back(recording->log);
    if (vehicle || !recording->stated) continue;
    if (!stated) stated = recording->stated;
    if (PrintVehicle(*stated) == PrintVehicle(*recording->stated)) continue;
    throw UsageError("vehicle: " + recordings.front()->log.path.string() + " and " +
                     recording->log.path.string() +
                     " state different ones; give the one that holds for all");
  }
  for (std::size_t i = 0; faults == InputFaults::kSought && i < logs.size(); ++i) {
    logs[i].fault = FaultAsRecorded(recordings[i]->recorded, logs[i].loaded.description, stated);
  }
  return Join(std::move(logs), std::move(stated), faults, [](const std::string&) {});
}

void AddRecording(py::module_& module) {
  RecordingClass recording(
      module, "Recording",
      "What a boat recorded: three channels of samples, each with its own times, without samples "
      "that cannot be trusted. Every array is a copy.");
  AddConstruction(recording);
  AddOrigin(recording);
  AddChannels(recording);
  recording
      .def(
          "save",
          [](const StatedLog& log, const fs::path& folder) {
            WriteTelemetryLog(folder, SamplesOf(log));
          },
          py::arg("folder"),
          "Writes a telemetry log: gnss.csv, heading.csv and thrusters.csv of a folder.")
      .def("__repr__", &RecordingText);

  module.def(
      "load", &Load, py::arg("path"), py::arg("vehicle") = py::none(),
      py::arg("mapping") = py::none(), py::kw_only(), py::arg("gps_instance") = py::none(),
      py::arg("system_id") = py::none(), py::arg("port_channel") = py::none(),
      py::arg("starboard_channel") = py::none(),
      "Reads a recording.\n\n"
      "Args:\n"
      "    path: a telemetry log (a folder with gnss.csv, heading.csv and thrusters.csv), an\n"
      "        ArduPilot .BIN, a .tlog, an .mcap of ROS 2 or BlueOS, a rosbag2 folder or .db3, a\n"
      "        ROS 1 .bag, or one CSV file with a mapping.\n"
      "    vehicle: a Vehicle, or the path of a vehicle file. Recordings of an autopilot can do\n"
      "        without.\n"
      "    mapping: the path of a mapping file, which says what holds what.\n"
      "    gps_instance: of .BIN logs, [0, 255]; by default the receiver with most fixes.\n"
      "    system_id: of MAVLink recordings, [1, 255]; by default the one that says most.\n"
      "    port_channel, starboard_channel: the outputs of the thrusters, [1, 16]; by default by\n"
      "        SERVOn_FUNCTION.\n\n"
      "Raises FileNotFoundError, InputError for arguments and files that are not as they should "
      "be, DataCannotTell where the file is no recording or lacks a channel.");
}

}  // namespace telltale::python
