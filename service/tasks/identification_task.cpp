#include "telltale/service/tasks/identification_task.hpp"

#include <utility>

#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/structure_choice.hpp"
#include "telltale/service/tasks/identification_options.hpp"

namespace telltale {
namespace {

/// With the score that chose the structure, where it was measured.
Result<ScoredModel> Made(const IdentificationTask& task, const IdentifyOptions& options,
                         const Progress& progress) {
  if (LeavesStructureToData(task.request, task.settings)) {
    return IdentifyInChosenStructure(task.recording, task.vehicle, options, progress);
  }
  auto identification = Identify(task.recording, task.vehicle, options, progress);
  if (!identification) return tl::unexpected(identification.error());
  return ScoredModel{*std::move(identification), {}};
}

/// To measure a score costs a second identification.
Promotion VerdictOn(const ScoredModel& made, const IdentificationTask& task,
                    const IdentifyOptions& options) {
  return made.score ? AssessPromotion(task.recording, task.vehicle, made.model, options, made.score)
                    : AssessPromotion(task.recording, task.vehicle, made.model, options);
}

}  // namespace

Result<AssessedModel> Compute(const IdentificationTask& task, const Progress& progress) {
  const IdentifyOptions options = OptionsOf(task.request, task.settings);
  auto made = Made(task, options, progress);
  if (!made) return tl::unexpected(made.error());
  progress("comparing with constant velocity", 0.0);
  const Promotion verdict = VerdictOn(*made, task, options);
  const auto reference_error = MeasureFreeRunError(task.recording, task.vehicle, made->model);
  return AssessedModel{std::move(made->model), verdict, reference_error};
}

}  // namespace telltale
