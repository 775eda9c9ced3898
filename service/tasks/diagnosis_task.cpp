#include "telltale/service/tasks/diagnosis_task.hpp"

#include <algorithm>
#include <thread>
#include <utility>
#include <vector>

#include "telltale/core/data/preparation.hpp"

namespace telltale {

DiagnoseOptions OptionsOf(const DiagnoseRequest& request, const IdentificationSettings& settings) {
  DiagnoseOptions options;
  options.refit = request.refit;
  options.without = request.without;
  options.seed = request.seed;
  options.threads = std::max(1u, std::thread::hardware_concurrency() / settings.workers);
  return options;
}

Result<DiagnosedModel> Compute(const DiagnosisTask& task, const Progress& progress) {
  progress("preparing data", 0.0);
  PrepareOptions preparation;
  preparation.sampling_period_s = task.model.sampling_period_s;
  const auto since = Prepare(task.since, task.vehicle, preparation);
  if (!since) return tl::unexpected(since.error());
  std::vector<PreparedDataset> references;
  if (task.baseline) {
    auto baseline = Prepare(*task.baseline, task.vehicle, preparation);
    if (!baseline) return tl::unexpected(std::move(baseline).error());
    references.push_back(*std::move(baseline));
  }
  return Diagnose(*since, references, task.model, task.vehicle.vehicle_id,
                  OptionsOf(task.request, task.settings), progress);
}

}  // namespace telltale
