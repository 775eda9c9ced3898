#include "telltale/core/diagnosis/diagnose.hpp"

#include <memory>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/diagnose_arguments.hpp"
#include "telltale/client/cli/diagnose_live.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/core/data/input_check.hpp"

namespace telltale {
namespace {

PrepareOptions PreparationFor(const Identification& model) {
  PrepareOptions options = PrepareOptions::Robust();
  options.sampling_period_s = model.sampling_period_s;
  return options;
}

bool Overlap(const RecordingIdentity& one_identity, const Recording& one,
             const RecordingIdentity& other_identity, const Recording& other) {
  return SharesFixes(one_identity, other) || SharesFixes(other_identity, one);
}

/// A reference log, known to be evidence of its own.
struct Reference {
  std::filesystem::path log;
  Recording recording;
  RecordingIdentity identity;
};

/// A reference shows what a nominal error is. The recording to diagnose may not be nominal, the
/// model fits the recordings that made it too well, and a recording given twice counts its day
/// twice.
void RequireOwnEvidence(const Reference& reference, const RecordedVehicle& diagnosed,
                        const Identification& model, const std::vector<Reference>& earlier) {
  const auto refuse = [&](const std::string& reason, const std::string& advice) {
    throw RefusedError({reference.log.string(), reason, advice});
  };
  for (const RecordingIdentity& log : diagnosed.logs) {
    if (Overlap(log, diagnosed.recording, reference.identity, reference.recording)) {
      refuse("is both the recording to diagnose and a reference",
             "give recordings of days on which the model held as references");
    }
  }
  for (const RecordingIdentity& made : model.provenance.recordings) {
    if (SharesFixes(made, reference.recording)) {
      refuse("made the model (as " + made.name + "), which fits it better than other recordings",
             "give references that did not make the model, or identify the model without this one");
    }
  }
  for (const Reference& other : earlier) {
    if (Overlap(other.identity, other.recording, reference.identity, reference.recording)) {
      refuse("holds the same recording as " + other.log.string(), "give each reference once");
    }
  }
}

std::vector<Reference> LoadReferences(const DiagnoseArguments& arguments,
                                      const RecordedVehicle& diagnosed,
                                      const Identification& model) {
  std::vector<Reference> references;
  for (const auto& log : arguments.reference_logs) {
    Reference reference{log, LoadAdmitted(log, arguments.inputs.options), {}};
    reference.identity = IdentityOf(reference.recording, NameOf(log));
    RequireOwnEvidence(reference, diagnosed, model, references);
    references.push_back(std::move(reference));
  }
  return references;
}

PreparedDataset PrepareReference(const Reference& reference, const Vehicle& vehicle,
                                 const PrepareOptions& options) {
  auto prepared = Prepare(reference.recording, vehicle, options);
  if (prepared) return *std::move(prepared);
  Refusal refusal = std::move(prepared).error();
  refusal.subject = reference.log.string() + ' ' + refusal.subject;
  throw RefusedError(std::move(refusal));
}

/// An id that a log alone suggests is nobody's choice, so it cannot contradict the model's.
std::string VehicleIdFor(const DiagnoseArguments& arguments, const Vehicle& vehicle,
                         const Identification& model) {
  return arguments.inputs.NamesVehicle() ? vehicle.vehicle_id : model.vehicle_id;
}

/// What the model's record of its recordings, or its absence, means for the answer.
void NoteRecordingsOf(const Identification& model, const RecordedVehicle& diagnosed,
                      bool has_references, Diagnosis& diagnosis) {
  const auto& recordings = model.provenance.recordings;
  if (has_references && recordings.empty()) {
    diagnosis.notes.emplace_back(
        "The model does not say which recordings made it, so nothing shows that the references did "
        "not.");
  }
  for (const RecordingIdentity& made : recordings) {
    if (!SharesFixes(made, diagnosed.recording)) continue;
    diagnosis.notes.push_back("The recording made the model (as " + made.name +
                              "), which fits it better than recordings that did not.");
  }
}

DiagnosedModel DiagnoseFromFiles(const DiagnoseArguments& arguments) {
  DiagnoseOptions options = arguments.Options();
  const Identification model = LoadModel(arguments.model_file);
  ProgressLine line;
  line.Update("reading logs", 0.0);
  const RecordedVehicle diagnosed = arguments.inputs.Load();
  line.Update("preparing data", 0.0);
  const PrepareOptions preparation = PreparationFor(model);
  const PreparedDataset dataset =
      OrThrow(Prepare(diagnosed.recording, diagnosed.vehicle, preparation));
  std::vector<PreparedDataset> references;
  std::vector<RecordingIdentity> evidence = diagnosed.logs;
  for (const Reference& reference : LoadReferences(arguments, diagnosed, model)) {
    references.push_back(PrepareReference(reference, diagnosed.vehicle, preparation));
    options.reference_names.push_back(reference.identity.name);
    evidence.push_back(reference.identity);
  }
  DiagnosedModel answer = OrThrow(Diagnose(
      dataset, references, model, VehicleIdFor(arguments, diagnosed.vehicle, model), options,
      [&line](std::string_view stage, double fraction) { line.Update(stage, fraction); }));
  if (answer.augmented) {
    auto& made_of = answer.augmented->provenance.recordings;
    made_of.insert(made_of.end(), evidence.begin(), evidence.end());
  }
  NoteRecordingsOf(model, diagnosed, !references.empty(), answer.diagnosis);
  return answer;
}

void DiagnoseLogs(const DiagnoseArguments& arguments) {
  const DiagnosedModel diagnosed = DiagnoseFromFiles(arguments);
  arguments.Write(diagnosed.diagnosis, diagnosed.augmented);
}

}  // namespace

void AddDiagnose(CLI::App& telltale) {
  const auto arguments = std::make_shared<DiagnoseArguments>();
  const auto vehicle_id = std::make_shared<std::string>();
  const auto live = std::make_shared<LiveOptions>();
  CLI::App& command = *telltale.add_subcommand(
      "diagnose",
      "Finds where a model and a recording differ, which effect explains it, and how much of the "
      "excess error it explains");
  auto* const whom = command.add_option_group("from", "logs, or a vehicle the daemon follows");
  whom->require_option(1);
  auto* const log = arguments->inputs.AddTo(command, *whom);
  AddVehicleId(*whom, *vehicle_id);
  arguments->AddOptionsTo(command, log);
  live->AddTo(command, 300.0, "with --vehicle-id: how long to wait for the answer");
  command.footer(
      "Give a recording of 60 s or more that did not make the model. Errors are in times the\n"
      "normal error, 1 is what a nominal recording shows.\n"
      "Example: telltale diagnose --log today --vehicle boat.textproto --model model.json \\\n"
      "             --reference-log last-week --html report.html --out report.json\n"
      "         telltale diagnose --vehicle-id boat-1");
  command.callback([arguments, vehicle_id, live] {
    vehicle_id->empty() ? DiagnoseLogs(*arguments) : DiagnoseLive(*vehicle_id, *arguments, *live);
  });
}

}  // namespace telltale
