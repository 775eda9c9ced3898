#include "telltale/core/validation/validation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/simulation/free_run.hpp"
#include "telltale/core/validation/augmented_free_runs.hpp"
#include "telltale/core/validation/physical_free_runs.hpp"

namespace telltale {
namespace {

// Sampling periods come from decimal logs: closer than this is equal.
constexpr double kSamePeriodS = 1e-6;

std::size_t PeriodsIn(double horizon_s, const PreparedDataset& dataset) {
  return static_cast<std::size_t>(std::lround(horizon_s / dataset.sampling_period_s));
}

std::optional<Refusal> RefuseUnanswerable(const PreparedDataset& dataset, const VesselModel& model,
                                          const ValidationOptions& options) {
  const bool has_pair = std::any_of(dataset.segments.begin(), dataset.segments.end(),
                                    [](const RowRange& segment) { return segment.size() >= 2; });
  if (!has_pair) {
    return Refusal{"validation", "no two consecutive rows without a gap between them",
                   "record at least a few seconds of position, heading and thruster commands"};
  }
  const double h = dataset.sampling_period_s;
  if (model.discretisation == Discretisation::kForwardEuler &&
      std::abs(model.sampling_period_s - h) > kSamePeriodS) {
    return Refusal{"sampling_period_s",
                   "the model is discrete with " + FormatSignificant(model.sampling_period_s, 6) +
                       " s, the data are sampled every " + FormatSignificant(h, 6) + " s",
                   "prepare the data at the model's sampling period"};
  }
  if (const auto horizon_s = options.HorizonOutOfRange(h)) {
    return Refusal{"horizons_s", FormatSignificant(*horizon_s, 6) + " s is out of range",
                   "choose horizons from two sampling periods (" + FormatSignificant(2.0 * h, 6) +
                       " s) to " + FormatSignificant(kLongestHorizonS, 6) + " s"};
  }
  return std::nullopt;
}

/// Free runs of a model that has coefficients alone.
class PlainFreeRuns {
 public:
  PlainFreeRuns(const PreparedDataset& dataset, const VesselModel& model)
      : dataset_(dataset), model_(model), thrust_(FollowThrust(dataset, model)) {}

  /// Calls visit(first row, predicted states from it on) for every run of `rows` periods.
  template <class Visit>
  void RunAll(std::size_t rows, Visit visit) const {
    for (const std::size_t first : FreeRunStarts(dataset_, rows)) {
      visit(first, RunFreely(dataset_, model_, thrust_, first, rows));
    }
  }

 private:
  const PreparedDataset& dataset_;
  const VesselModel& model_;
  ThrustHistory thrust_;
};

template <class FreeRuns>
std::vector<FreeRun> Gathered(const PreparedDataset& dataset, const FreeRuns& free_runs,
                              double horizon_s) {
  std::vector<FreeRun> runs;
  free_runs.RunAll(PeriodsIn(horizon_s, dataset), [&](std::size_t first, const auto& predicted) {
    FreeRun& run = runs.emplace_back(FreeRun{first, {}});
    for (std::size_t k = 0; k < predicted.size(); ++k) {
      PreparedRow row;
      row.time_s = dataset.rows[first + k].time_s;
      row.eta = predicted[k].eta;
      row.nu = predicted[k].nu;
      run.predicted.push_back(row);
    }
  });
  return runs;
}

/// A horizon of one period is no score, but a run.
ValidationOptions OptionsForRuns(const PreparedDataset& dataset, double horizon_s) {
  const bool is_one_step = std::abs(horizon_s - dataset.sampling_period_s) < kSamePeriodS;
  return {is_one_step ? std::vector<double>{} : std::vector<double>{horizon_s}};
}

template <class FreeRuns>
std::array<OneStepScore, 3> ScoreOneStep(const PreparedDataset& dataset,
                                         const FreeRuns& free_runs) {
  VelocityErrorSums sums;
  free_runs.RunAll(1, [&](std::size_t first, const auto& predicted) {
    sums.Add(dataset.rows[first].nu, dataset.rows[first + 1].nu, predicted[1].nu);
  });
  return sums.OfOneStep();
}

template <class FreeRuns>
FreeRunScores ScoresOfHorizon(const PreparedDataset& dataset, const FreeRuns& free_runs,
                              double horizon_s) {
  FreeRunSums sums;
  free_runs.RunAll(PeriodsIn(horizon_s, dataset), [&](std::size_t first, const auto& predicted) {
    sums.Add(dataset, predicted, first);
  });
  return sums.Scores(dataset, horizon_s);
}

template <class FreeRuns>
Metrics ScoresOfRuns(const PreparedDataset& dataset, const FreeRuns& free_runs,
                     const ValidationOptions& options) {
  Metrics metrics;
  metrics.one_step = ScoreOneStep(dataset, free_runs);
  for (const double horizon_s : options.horizons_s) {
    metrics.free_run.push_back(ScoresOfHorizon(dataset, free_runs, horizon_s));
  }
  return metrics;
}

}  // namespace

std::optional<double> ValidationOptions::HorizonOutOfRange(double sampling_period_s) const {
  for (const double horizon_s : horizons_s) {
    const bool allowed =
        horizon_s >= 2.0 * sampling_period_s - kSamePeriodS && horizon_s <= kLongestHorizonS;
    if (!allowed) return horizon_s;
  }
  return std::nullopt;
}

ValidationOptions UsualOptions(double sampling_period_s) {
  ValidationOptions options;
  std::erase_if(options.horizons_s, [&](double horizon_s) {
    return ValidationOptions{{horizon_s}}.HorizonOutOfRange(sampling_period_s).has_value();
  });
  return options;
}

Result<Metrics> Validate(const PreparedDataset& dataset, const VesselModel& model,
                         const ValidationOptions& options) {
  if (auto refusal = RefuseUnanswerable(dataset, model, options)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  return ScoresOfRuns(dataset, PlainFreeRuns(dataset, model), options);
}

Result<Metrics> Validate(const PreparedDataset& dataset, const AugmentedModel& model,
                         const ValidationOptions& options) {
  if (model.effects.empty()) return Validate(dataset, model.model, options);
  if (auto refusal = RefuseUnanswerable(dataset, model.model, options)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  return ScoresOfRuns(dataset, AugmentedFreeRuns(dataset, model), options);
}

Result<std::vector<FreeRun>> FreeRunsOf(const PreparedDataset& dataset, const AugmentedModel& model,
                                        double horizon_s) {
  const auto options = OptionsForRuns(dataset, horizon_s);
  if (auto refusal = RefuseUnanswerable(dataset, model.model, options)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  if (model.effects.empty()) {
    return Gathered(dataset, PlainFreeRuns(dataset, model.model), horizon_s);
  }
  return Gathered(dataset, AugmentedFreeRuns(dataset, model), horizon_s);
}

Result<std::vector<FreeRun>> FreeRunsOf(const PreparedDataset& dataset, const PhysicalModel& model,
                                        double horizon_s) {
  const VesselModel vessel = VesselModelOf(model.Estimates(), model.propeller_separation_m);
  if (auto refusal = RefuseUnanswerable(dataset, vessel, OptionsForRuns(dataset, horizon_s))) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  return Gathered(dataset, PhysicalFreeRuns(dataset, model), horizon_s);
}

Result<Metrics> Validate(const PreparedDataset& dataset, const PhysicalModel& model,
                         const ValidationOptions& options) {
  const VesselModel vessel = VesselModelOf(model.Estimates(), model.propeller_separation_m);
  if (auto refusal = RefuseUnanswerable(dataset, vessel, options)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  return ScoresOfRuns(dataset, PhysicalFreeRuns(dataset, model), options);
}

Result<Metrics> Validate(const PreparedDataset& dataset, const Identification& identification,
                         const ValidationOptions& options) {
  if (identification.physical) return Validate(dataset, *identification.physical, options);
  const auto model = ModelOf(identification);
  if (!model) return tl::unexpected(model.error());
  return Validate(dataset, *model, options);
}

Result<FreeRunScores> ScoreFreeRuns(const PreparedDataset& dataset,
                                    const Identification& identification, double horizon_s) {
  const auto model = ModelOf(identification);
  if (!model) return tl::unexpected(model.error());
  if (auto refusal = RefuseUnanswerable(dataset, *model, {{horizon_s}})) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  if (identification.physical) {
    return ScoresOfHorizon(dataset, PhysicalFreeRuns(dataset, *identification.physical), horizon_s);
  }
  return ScoresOfHorizon(dataset, PlainFreeRuns(dataset, *model), horizon_s);
}

}  // namespace telltale
