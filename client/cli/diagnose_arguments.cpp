#include "telltale/client/cli/diagnose_arguments.hpp"

#include <iostream>

#include "telltale/client/cli/diagnosis_table.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale {
namespace {

void WriteModel(const std::optional<Identification>& augmented, const std::filesystem::path& file) {
  if (augmented) {
    WriteFile(file, PrintModelJson(*augmented));
  } else {
    std::cerr << "note: " << file.string()
              << " is not written, since no effect is likely that would improve the model\n";
  }
}

}  // namespace

void DiagnoseArguments::AddOptionsTo(CLI::App& command, CLI::Option* log) {
  auto* const model = AddModelFile(command, model_file)->required(false)->needs(log);
  log->needs(model);
  command
      .add_option(
          "--reference-log", reference_logs,
          "logs of the same boat in its nominal state, which say how large the normal error "
          "is; without any the floor is the error that sensor noise alone leaves")
      ->type_name("LOG")
      ->check(CLI::ExistingPath.description(""))
      ->needs(log);
  command.add_flag("--refit", choices.refit,
                   "let the model's coefficients follow the recording, within their bounds, so "
                   "that only what no coefficient can imitate counts");
  command
      .add_option("--without", choices.without,
                  "effects to leave out of those that may be the cause")
      ->type_name("EFFECT")
      ->check(CLI::Validator(EffectFault, ""));
  command
      .add_option("--seed", choices.seed, "of the bootstrap: the same seed gives the same report")
      ->type_name("N")
      ->check(WholeNumber())
      ->capture_default_str();
  command
      .add_flag("--skip-influence", choices.skip_influence,
                "do not diagnose once more without each reference, which takes most of the time")
      ->needs(log);
  command.add_option("--threads", choices.threads, "[1, 256], default: what the machine has")
      ->type_name("N")
      ->check(WholeNumber())
      ->needs(log);
  command.add_option("--html", html, "also write a page with pictures, which needs no network")
      ->type_name("FILE.html");
  command
      .add_option("--out-model", out_model,
                  "also write the model identified again with the likely effects, which "
                  "validate and simulate take like any other")
      ->type_name("FILE");
  output.AddTo(command, "report.json");
}

void DiagnoseArguments::Write(const Diagnosis& diagnosis,
                              const std::optional<Identification>& augmented,
                              const ReportSources& sources, const std::string& against) const {
  if (!out_model.empty()) WriteModel(augmented, out_model);
  if (!html.empty()) WriteFile(html, ReportPage(diagnosis, sources));
  output.Write(PrintReportJson(diagnosis), [&] {
    return DiagnosisTable(diagnosis) + (against.empty() ? "" : '\n' + Wrapped(against));
  });
}

}  // namespace telltale
