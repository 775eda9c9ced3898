#include "telltale/client/workbench/diagnose_recorded.hpp"

#include <filesystem>
#include <utility>

#include "telltale/client/workbench/default_threads.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

PrepareOptions PreparationFor(const Identification& model) {
  PrepareOptions options = PrepareOptions::Robust();
  options.sampling_period_s = model.sampling_period_s;
  return options;
}

std::string EffectNames() {
  std::string names;
  for (const Effect* effect : EffectLibrary()) {
    names.append(names.empty() ? "" : ", ").append(effect->Name());
  }
  return names;
}

/// A reference log, known to be evidence of its own.
struct Reference {
  std::filesystem::path log;
  Recording recording;
  RecordingIdentity identity;
  FixMarks marks;
};

/// A reference shows what a nominal error is. The recording to diagnose may not be nominal, the
/// model fits the recordings that made it too well, and a recording given twice counts its day
/// twice.
void RequireOwnEvidence(const Reference& reference, const RecordedVehicle& diagnosed,
                        const FixMarks& marks_of_diagnosed, const Identification& model,
                        const std::vector<Reference>& earlier) {
  const auto refuse = [&](const std::string& reason, const std::string& advice) {
    throw RefusedError({reference.log.string(), reason, advice});
  };
  for (const RecordingIdentity& log : diagnosed.logs) {
    if (Overlap(log, marks_of_diagnosed, reference.identity, reference.marks)) {
      refuse("is both the recording to diagnose and a reference",
             "give recordings of days on which the model held as references");
    }
  }
  for (const RecordingIdentity& made : model.provenance.recordings) {
    if (SharesFixes(made, reference.marks)) {
      refuse("made the model (as " + made.name + "), which fits it better than other recordings",
             "give references that did not make the model, or identify the model without this one");
    }
  }
  for (const Reference& other : earlier) {
    if (Overlap(other.identity, other.marks, reference.identity, reference.marks)) {
      refuse("holds the same recording as " + other.log.string(), "give each reference once");
    }
  }
}

std::vector<Reference> ReferencesOf(std::vector<RecordedLog> logs, const RecordedVehicle& diagnosed,
                                    const FixMarks& marks_of_diagnosed,
                                    const Identification& model) {
  std::vector<Reference> references;
  for (RecordedLog& log : logs) {
    Reference reference{log.path, std::move(log.loaded.recording), {}, {}};
    reference.identity = IdentityOf(reference.recording, NameOf(log.path));
    reference.marks = MarksOf(reference.recording);
    RequireOwnEvidence(reference, diagnosed, marks_of_diagnosed, model, references);
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

/// What the model's record of its recordings, or its absence, means for the answer.
void NoteRecordingsOf(const Identification& model, const FixMarks& marks_of_diagnosed,
                      bool has_references, Diagnosis& diagnosis) {
  const auto& recordings = model.provenance.recordings;
  if (has_references && recordings.empty()) {
    diagnosis.notes.emplace_back(
        "The model does not say which recordings made it, so nothing shows that the references did "
        "not.");
  }
  for (const RecordingIdentity& made : recordings) {
    if (!SharesFixes(made, marks_of_diagnosed)) continue;
    diagnosis.notes.push_back("The recording made the model (as " + made.name +
                              "), which fits it better than recordings that did not.");
  }
}

}  // namespace

std::string EffectFault(const std::string& name) {
  return FindEffect(name) ? "" : "no such effect as " + name + "; there are " + EffectNames();
}

DiagnoseOptions DiagnoseChoices::Options() const {
  DiagnoseOptions options;
  options.refit = refit;
  options.without = without;
  options.seed = seed;
  options.leave_out_references = !skip_influence;
  options.threads = threads.value_or(DefaultThreads());
  if (const auto refusal = options.Validate()) {
    throw UsageError(refusal->subject + ": " + refusal->reason + "; " + refusal->advice);
  }
  return options;
}

DiagnosedModel DiagnoseRecorded(const Identification& model, const RecordedVehicle& diagnosed,
                                std::vector<RecordedLog> references, const std::string& vehicle_id,
                                const DiagnoseChoices& choices, const Progress& progress) {
  DiagnoseOptions options = choices.Options();
  progress("preparing data", 0.0);
  const PrepareOptions preparation = PreparationFor(model);
  const PreparedDataset dataset =
      OrThrow(Prepare(diagnosed.recording, diagnosed.vehicle, preparation));
  const FixMarks marks = MarksOf(diagnosed.recording);
  std::vector<PreparedDataset> nominal;
  std::vector<RecordingIdentity> evidence = diagnosed.logs;
  for (const Reference& reference : ReferencesOf(std::move(references), diagnosed, marks, model)) {
    nominal.push_back(PrepareReference(reference, diagnosed.vehicle, preparation));
    options.reference_names.push_back(reference.identity.name);
    evidence.push_back(reference.identity);
  }
  DiagnosedModel answer = OrThrow(Diagnose(dataset, nominal, model, vehicle_id, options, progress));
  if (answer.augmented) {
    auto& made_of = answer.augmented->provenance.recordings;
    made_of.insert(made_of.end(), evidence.begin(), evidence.end());
  }
  NoteRecordingsOf(model, marks, !nominal.empty(), answer.diagnosis);
  return answer;
}

}  // namespace telltale
