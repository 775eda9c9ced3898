#include <filesystem>
#include <iostream>
#include <memory>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/workbench/recorded_log.hpp"

namespace telltale {
namespace {

struct ImportArguments {
  std::filesystem::path log;
  SourceOptions options;
  std::filesystem::path out;
};

void ImportLog(const ImportArguments& arguments) {
  const Recording recording =
      Admitted(arguments.log, ReadShown(arguments.log, arguments.options), PrintNote)
          .loaded.recording;
  WriteTelemetryLog(arguments.out, recording);
  std::cout << Wrapped("Wrote " + Counted(recording.gnss.size(), "position", "positions") + ", " +
                       Counted(recording.heading.size(), "heading", "headings") + " and " +
                       Counted(recording.thrusters.size(), "command", "commands") + " to " +
                       arguments.out.string() + "; " +
                       Counted(recording.rejected.Total(), "sample", "samples") + " rejected.");
}

}  // namespace

void AddImport(CLI::App& telltale) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App& command =
      *telltale.add_subcommand("import", "Turns a log of any readable format into a telemetry log");
  AddLog(command, arguments->log, arguments->options);
  command.add_option("--out", arguments->out, "folder for gnss.csv, heading.csv and thrusters.csv")
      ->type_name("DIR")
      ->required();
  command.footer("Example: telltale import --log flight.tlog --out run1");
  command.callback([arguments] { ImportLog(*arguments); });
}

}  // namespace telltale
