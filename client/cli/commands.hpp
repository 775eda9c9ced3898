#pragma once

#include <CLI/CLI.hpp>

namespace telltale {

/// Each function adds one subcommand, which runs when the command line is parsed. Where it does not
/// succeed it throws what exit_codes.hpp names, or any other exception for a failure.
void AddIdentify(CLI::App& telltale);
void AddValidate(CLI::App& telltale);
void AddDiagnose(CLI::App& telltale);
void AddSimulate(CLI::App& telltale);
void AddExport(CLI::App& telltale);
void AddGain(CLI::App& telltale);
void AddCompare(CLI::App& telltale);
void AddReplay(CLI::App& telltale);
void AddBridge(CLI::App& telltale);
void AddWatch(CLI::App& telltale);
void AddMonitor(CLI::App& telltale);
void AddList(CLI::App& telltale);
void AddHistory(CLI::App& telltale);
void AddRollback(CLI::App& telltale);
void AddRetire(CLI::App& telltale);
void AddRefresh(CLI::App& telltale);
void AddLoad(CLI::App& telltale);
void AddStudy(CLI::App& telltale);
void AddCheck(CLI::App& telltale);
void AddImport(CLI::App& telltale);
void AddInit(CLI::App& telltale);

}  // namespace telltale
