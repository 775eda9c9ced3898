#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "telltale/client/recording/source_log.hpp"
#include "telltale/client/workbench/recorded_vehicle.hpp"

namespace telltale {

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

  /// All logs joined (Join), with the vehicle of its file, if one is named. Rows that could not be
  /// read, and what was taken for the vehicle, are noted on standard error. Throws: as
  /// RequireSelfDescribing, LoadVehicle, LoadLog and Join.
  RecordedVehicle Load() const;
};

/// `--log`, required, of a subcommand that takes one log and no vehicle, with what to take from a
/// file that offers a choice.
CLI::Option* AddLog(CLI::App& command, std::filesystem::path& log, SourceOptions& options);

/// A log before any admission (LoadAsRecorded), of which channels may be missing; where reading
/// takes long, a line on a terminal shows how far it is.
RawLog ReadShown(const std::filesystem::path& log, SourceOptions options);

/// `--model` and `--vehicle`, required.
CLI::Option* AddModelFile(CLI::App& command, std::filesystem::path& file);
CLI::Option* AddVehicleFile(CLI::App& command, std::filesystem::path& file);

/// `--include-rr`: RegressionOptions::include_reverse.
void AddIncludeRr(CLI::App& command, bool& include_reverse);

/// Prints a note on standard error.
void PrintNote(const std::string& note);

}  // namespace telltale
