#include "telltale/service/tasks/identification_task.hpp"

#include <utility>

#include "telltale/core/validation/structure_choice.hpp"
#include "telltale/service/tasks/identification_options.hpp"

namespace telltale {
namespace {

/// To measure a score costs a second identification.
Promotion VerdictOn(const ScoredModel& made, const IdentificationTask& task,
                    const IdentifyOptions& options) {
  return made.score ? AssessPromotion(task.recording, task.vehicle, made.model, options, made.score)
                    : AssessPromotion(task.recording, task.vehicle, made.model, options);
}

}  // namespace

Result<AssessedModel> Compute(const IdentificationTask& task, const Progress& progress) {
  const IdentifyOptions options = OptionsOf(task.request, task.settings);
  const auto identify = LeavesStructureToData(task.request, task.settings)
                            ? IdentifyInChosenStructure
                            : IdentifyInGivenStructure;
  auto made = identify(task.recording, task.vehicle, options, progress);
  if (!made) return tl::unexpected(made.error());
  progress("comparing with constant velocity", 0.0);
  const Promotion verdict = VerdictOn(*made, task, options);
  const auto reference_error = MeasureFreeRunError(task.recording, task.vehicle, made->model);
  return AssessedModel{std::move(made->model), verdict, reference_error};
}

}  // namespace telltale
