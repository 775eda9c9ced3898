#include "telltale/service/models/predicted_paths.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {
namespace {

constexpr double kBetweenPathPointsS = 1.0;
// What the filters of the preparation cut off at the ends of a recording.
constexpr double kEdgesS = 5.0;
// A boat that has gone that far within a run has not: the model diverges.
constexpr double kFarthestM = 1e5;

Result<std::vector<FreeRun>> RunsOf(const PreparedDataset& dataset,
                                    const Identification& identification, double horizon_s) {
  if (identification.physical) return FreeRunsOf(dataset, *identification.physical, horizon_s);
  const auto model = AugmentedModelOf(identification);
  if (!model) return tl::unexpected(model.error());
  return FreeRunsOf(dataset, *model, horizon_s);
}

double Distance(const Eta& a, const Eta& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// False where the distance is NaN too.
bool IsFollowed(const Eta& eta, const Eta& start) {
  return Distance(eta, start) <= kFarthestM;
}

/// Every `step`-th of the rows and the last, up to the one that diverges.
Path Thinned(std::span<const PreparedRow> rows, std::size_t step, const Eta& origin) {
  Path path;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i % step != 0 && i + 1 < rows.size()) continue;
    if (!IsFollowed(rows[i].eta, rows.front().eta)) break;
    path.time_s.push_back(rows[i].time_s);
    path.north_m.push_back(rows[i].eta.x_m - origin.x_m);
    path.east_m.push_back(rows[i].eta.y_m - origin.y_m);
  }
  return path;
}

double PositionRmse(const PreparedDataset& dataset, const std::vector<FreeRun>& runs) {
  double squared_m2 = 0.0;
  for (const FreeRun& run : runs) {
    const Eta& measured = dataset.rows[run.first_row + run.predicted.size() - 1].eta;
    const double distance_m = Distance(run.predicted.back().eta, measured);
    squared_m2 += std::isfinite(distance_m) ? distance_m * distance_m
                                            : std::numeric_limits<double>::infinity();
  }
  return std::sqrt(squared_m2 / static_cast<double>(runs.size()));
}

Refusal NoRunFits(double horizon_s) {
  return {"window", "no " + FormatNumber(horizon_s, 0) + " s of it are without a gap",
          "wait for more telemetry, or ask for a shorter horizon"};
}

}  // namespace

Result<PredictedPaths> PredictPaths(const Recording& recording, const Vehicle& vehicle,
                                    const Identification& identification, double span_s,
                                    double horizon_s) {
  PrepareOptions options;
  options.sampling_period_s = identification.sampling_period_s;
  const auto dataset = Prepare(Latest(recording, span_s + kEdgesS), vehicle, options);
  if (!dataset) return tl::unexpected(dataset.error());
  const auto runs = RunsOf(*dataset, identification, horizon_s);
  if (!runs) return tl::unexpected(runs.error());
  if (runs->empty()) return tl::unexpected(NoRunFits(horizon_s));
  const auto step = static_cast<std::size_t>(
      std::max(1L, std::lround(kBetweenPathPointsS / dataset->sampling_period_s)));
  const Eta origin = dataset->rows.front().eta;
  PredictedPaths paths;
  paths.horizon_s = horizon_s;
  paths.measured = Thinned(dataset->rows, step, origin);
  for (const FreeRun& run : *runs) {
    paths.predicted.push_back(Thinned(run.predicted, step, origin));
  }
  paths.position_rmse_m = PositionRmse(*dataset, *runs);
  return paths;
}

}  // namespace telltale
