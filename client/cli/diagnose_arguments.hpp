#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/report/report_page.hpp"
#include "telltale/client/workbench/diagnose_recorded.hpp"
#include "telltale/core/diagnosis/diagnose.hpp"

namespace telltale {

/// What `telltale diagnose` was asked.
struct DiagnoseArguments {
  LogInputs inputs;
  std::filesystem::path model_file;
  std::vector<std::filesystem::path> reference_logs;
  std::filesystem::path html;       ///< empty: no page
  std::filesystem::path out_model;  ///< empty: no model
  DiagnoseChoices choices;
  OutputOptions output;

  /// The options that go with `--log`, those that say how to diagnose and those that say where the
  /// answer goes.
  void AddOptionsTo(CLI::App& command, CLI::Option* log);

  /// The model, the page, the JSON and the table, as far as they were asked for; `against` says in
  /// the table what the recording was held against, `sources` in the page where it comes from.
  /// Where no effect is likely there is no model to write, which a note says.
  void Write(const Diagnosis& diagnosis, const std::optional<Identification>& augmented,
             const ReportSources& sources, const std::string& against = "") const;
};

}  // namespace telltale
