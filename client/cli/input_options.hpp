#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/recording/source_log.hpp"
#include "telltale/core/data/preparation.hpp"
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

/// Logs and the vehicle that made them, as a command line names them.
struct LogInputs {
  std::vector<std::filesystem::path> logs;
  std::filesystem::path vehicle_file;  ///< empty: the vehicle is what the logs themselves describe
  SourceOptions options;
  bool skip_input_check = true;  ///< AddInputCheckTo turns the check on

  /// `--skip-input-check`: Load() then seeks no faults of input, which otherwise it does.
  void AddInputCheckTo(CLI::App& command);

  /// `--log`, to `whom` (the command itself or a group of its options), and what goes with it:
  /// `--vehicle` and what to take from a file that offers a choice. Returns `--log`.
  CLI::Option* AddTo(CLI::App& command, CLI::App& whom);

  /// Whether the vehicle comes from a file, so that its id is one that somebody chose.
  bool NamesVehicle() const { return !vehicle_file.empty(); }

  /// One recording of all logs, admitted one by one and put one after the other (Concatenate), and
  /// the vehicle: of its file or else VehicleFrom the first log. Rows that could not be read, and
  /// what was taken for the vehicle, are noted on standard error. Throws: UsageError where neither
  /// a file nor every log describes the vehicle, RefusedError naming the log (with the first fault
  /// of its input, unless skip_input_check; or with the log that it repeats), and as LoadVehicle.
  RecordedVehicle Load() const;
};

/// One log before any admission. Throws: RefusedError naming the log, UsageError where its format
/// does not record a channel that is asked for.
RawLog LoadAsRecorded(const std::filesystem::path& log, const SourceOptions& options);

/// One log, admitted, with what was left out of it noted on standard error. Throws: RefusedError
/// naming the log.
Recording LoadAdmitted(const std::filesystem::path& log, const SourceOptions& options);

/// "run225" of /data/run225 and of /data/run225/.
std::string NameOf(const std::filesystem::path& log);

/// `--log`, required, of a subcommand that takes one log and no vehicle, with what to take from a
/// file that offers a choice.
CLI::Option* AddLog(CLI::App& command, std::filesystem::path& log, SourceOptions& options);

/// `--model` and `--vehicle`, required.
CLI::Option* AddModelFile(CLI::App& command, std::filesystem::path& file);
CLI::Option* AddVehicleFile(CLI::App& command, std::filesystem::path& file);

/// `--include-rr`: RegressionOptions::include_reverse.
void AddIncludeRr(CLI::App& command, bool& include_reverse);

/// A mapping file, a vehicle file. Throw: std::runtime_error naming file, line, field, value and
/// range.
std::shared_ptr<const Mapping> LoadMapping(const std::filesystem::path& file);
Vehicle LoadVehicle(const std::filesystem::path& file);

/// model.json. Throws: std::runtime_error naming file, field, value and what is allowed.
Identification LoadModel(const std::filesystem::path& file);

/// "robust" or "paper".
Preset PresetNamed(const std::string& name);
PrepareOptions PrepareOptionsOf(Preset preset);

/// Those that the model was made with, unless another preset is asked for by its name.
PrepareOptions PrepareOptionsOf(const Identification& model,
                                const std::optional<std::string>& preset = {});

/// Tells on standard error when a model was identified on another vehicle.
void NoteOtherVehicle(const Identification& model, const Vehicle& vehicle);

}  // namespace telltale
