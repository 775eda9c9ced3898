#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/help_formatter.hpp"

namespace telltale {
namespace {

/// CLI11 would say only that a command is missing.
bool NamesNoCommand(const CLI::App& app, int argc, char** argv) {
  return app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-';
}

ExitCode Run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return ExitCode::kSuccess;
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
  CLI::App app(
      "Identifies how autonomous surface vehicles answer to their thrusters, with bounds.");
  app.name("telltale");
  app.formatter(std::make_shared<telltale::HelpFormatter>());
  app.require_subcommand(1);
  app.footer("Exit codes: 0 success, 1 failure, 2 usage error, 3 the data cannot answer.");
  telltale::AddIdentify(app);
  telltale::AddValidate(app);
  telltale::AddDiagnose(app);
  telltale::AddSimulate(app);
  telltale::AddExport(app);
  telltale::AddGain(app);
  telltale::AddCompare(app);
  telltale::AddReplay(app);
  telltale::AddWatch(app);
  telltale::AddMonitor(app);
  telltale::AddStudy(app);
  return static_cast<int>(telltale::Run(app, argc, argv));
}
