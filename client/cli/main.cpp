#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/help_formatter.hpp"
#include "telltale/client/cli/library_logs.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/base/version.hpp"

namespace telltale {
namespace {

/// A first word that is no command: CLI11 says only that a command is missing.
bool NamesNoCommand(const CLI::App& app, int argc, char** argv) {
  return app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-';
}

ExitCode Run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    if (std::cout.flush()) return ExitCode::kSuccess;
    std::cerr << "telltale: standard output cannot be written\n";
    return ExitCode::kFailure;
  } catch (const CLI::ParseError& error) {
    if (NamesNoCommand(app, argc, argv)) {
      std::cerr << argv[1] << ": no such command\nRun with --help for those there are.\n";
      return ExitCode::kUsage;
    }
    return app.exit(error) == 0 ? ExitCode::kSuccess : ExitCode::kUsage;
  } catch (const UsageError& error) {
    std::cerr << "telltale: " << error.what() << '\n';
    return ExitCode::kUsage;
  } catch (const RefusedError& error) {
    std::cerr << "telltale: the data cannot answer\n" << Explained(error.Answer());
    return ExitCode::kRefused;
  } catch (const std::exception& error) {
    std::cerr << "telltale: " << error.what() << '\n';
    return ExitCode::kFailure;
  }
}

}  // namespace
}  // namespace telltale

int main(int argc, char** argv) {
  const telltale::LibraryLogs logs;
  CLI::App app(
      "Identifies how autonomous surface vehicles respond to their thrusters, with bounds.");
  app.name("telltale");
  app.formatter(std::make_shared<telltale::HelpFormatter>());
  app.require_subcommand(1);
  app.set_version_flag("--version", "telltale " + std::string(telltale::Version()));
  app.footer(
      "Exit codes: 0 success, 1 any other failure, 2 usage error, 3 the data cannot answer.");
  telltale::AddInit(app);
  telltale::AddCheck(app);
  telltale::AddImport(app);
  telltale::AddIdentify(app);
  telltale::AddValidate(app);
  telltale::AddDiagnose(app);
  telltale::AddSimulate(app);
  telltale::AddExport(app);
  telltale::AddGain(app);
  telltale::AddCompare(app);
  telltale::AddReplay(app);
  telltale::AddBridge(app);
  telltale::AddWatch(app);
  telltale::AddMonitor(app);
  telltale::AddList(app);
  telltale::AddHistory(app);
  telltale::AddRollback(app);
  telltale::AddRefresh(app);
  telltale::AddRetire(app);
  telltale::AddLoad(app);
  telltale::AddStudy(app);
  return static_cast<int>(telltale::Run(app, argc, argv));
}
