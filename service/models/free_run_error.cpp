#include "telltale/service/models/free_run_error.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {
namespace {

constexpr double kHorizonS = 5.0;

}  // namespace

std::optional<FreeRunError> MeasureFreeRunError(const Recording& recording, const Vehicle& vehicle,
                                                const Identification& identification) {
  PrepareOptions options;
  options.sampling_period_s = identification.sampling_period_s;
  const auto dataset = Prepare(recording, vehicle, options);
  if (!dataset) return std::nullopt;
  const auto scores = ScoreFreeRuns(*dataset, identification, kHorizonS);
  if (!scores || scores->windows == 0) return std::nullopt;
  if (Diverges(*scores, kFreeRunDivergence.LimitsFor(FastestOf(*dataset)))) return std::nullopt;
  FreeRunError error;
  std::ranges::transform(scores->velocity, error.begin(), &FreeRunScore::rmse);
  return error;
}

double RelativeError(const FreeRunError& now, const FreeRunError& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double ratio = now[i] / std::max(reference[i], 1e-9);
    sum += ratio * ratio;
  }
  return std::sqrt(sum / static_cast<double>(now.size()));
}

}  // namespace telltale
