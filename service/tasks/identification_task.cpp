#include "telltale/service/tasks/identification_task.hpp"

#include <utility>

#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/structure_choice.hpp"
#include "telltale/service/tasks/identification_options.hpp"

namespace telltale {
namespace {

Result<Identification> InChosenStructure(const IdentificationTask& task,
                                         const IdentifyOptions& options, const Progress& progress) {
  auto made = IdentifyInChosenStructure(task.recording, task.vehicle, options, progress);
  if (!made) return tl::unexpected(made.error());
  return std::move(made->model);
}

}  // namespace

Result<AssessedModel> Compute(const IdentificationTask& task, const Progress& progress) {
  const IdentifyOptions options = OptionsOf(task.request, task.settings);
  auto identification = LeavesStructureToData(task.request, task.settings)
                            ? InChosenStructure(task, options, progress)
                            : Identify(task.recording, task.vehicle, options, progress);
  if (!identification) return tl::unexpected(std::move(identification).error());
  progress("comparing with constant velocity", 0.0);
  AssessedModel model{*std::move(identification), {}, {}};
  model.promotion = AssessPromotion(task.recording, task.vehicle, model.identification, options);
  model.reference_error = MeasureFreeRunError(task.recording, task.vehicle, model.identification);
  return model;
}

}  // namespace telltale
