#include "telltale/core/validation/validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/effects/augmented_boat.hpp"
#include "telltale/core/effects/sensor_chain.hpp"
#include "telltale/core/simulation/free_run.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/validation/physical_free_runs.hpp"

namespace telltale {
namespace {

// Sampling periods come from decimal logs: closer than this is equal.
constexpr double kSamePeriodS = 1e-6;

using Velocity = std::array<double, 3>;

Velocity ToArray(const Nu& nu) {
  return {nu.u, nu.v, nu.r};
}

VesselState Measured(const PreparedRow& row, const ThrustRegressors& thrust) {
  return {row.eta, row.nu, thrust};
}

// The error of a diverged free run is infinite, not NaN.
double ErrorOf(double truth, double predicted) {
  const double error = truth - predicted;
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

// Sums over pairs of a true and a predicted velocity.
class ErrorSums {
 public:
  void Add(double truth, double predicted) {
    const double error = ErrorOf(truth, predicted);
    squared_error_ += error * error;
    absolute_error_ += std::abs(error);
    // Welford's update: the spread of a slow drift about a large mean survives rounding.
    count_ += 1.0;
    const double from_old_mean = truth - mean_;
    mean_ += from_old_mean / count_;
    squared_spread_ += from_old_mean * (truth - mean_);
  }

  double R2() const {
    if (squared_spread_ <= 0.0) return std::numeric_limits<double>::quiet_NaN();
    return 1.0 - squared_error_ / squared_spread_;
  }
  double Mae() const { return absolute_error_ / count_; }
  double Rmse() const { return std::sqrt(squared_error_ / count_); }

 private:
  double count_ = 0.0;
  double mean_ = 0.0;
  double squared_spread_ = 0.0;
  double squared_error_ = 0.0;
  double absolute_error_ = 0.0;
};

using SumsByVelocity = std::array<ErrorSums, 3>;

void Add(SumsByVelocity& sums, const Nu& truth, const Nu& predicted) {
  const Velocity nu = ToArray(truth);
  const Velocity nu_hat = ToArray(predicted);
  for (std::size_t j = 0; j < sums.size(); ++j) sums[j].Add(nu[j], nu_hat[j]);
}

std::array<OneStepScore, 3> OneStepScoresOf(const SumsByVelocity& of_model,
                                            const SumsByVelocity& of_constant_velocity) {
  std::array<OneStepScore, 3> scores;
  for (std::size_t j = 0; j < scores.size(); ++j) {
    scores[j] = {of_model[j].R2(), of_model[j].Mae(), of_constant_velocity[j].R2()};
  }
  return scores;
}

std::array<OneStepScore, 3> ScoreOneStep(const PreparedDataset& dataset, const VesselModel& model,
                                         const ThrustHistory& thrust) {
  SumsByVelocity of_model;
  SumsByVelocity of_constant_velocity;
  for (const RowRange& segment : dataset.segments) {
    for (std::size_t k = segment.begin; k + 1 < segment.end; ++k) {
      const PreparedRow& now = dataset.rows[k];
      const Nu& next = dataset.rows[k + 1].nu;
      Add(of_model, next,
          Advance(model, Measured(now, thrust[k]), now.delta, dataset.sampling_period_s).nu);
      Add(of_constant_velocity, next, now.nu);
    }
  }
  return OneStepScoresOf(of_model, of_constant_velocity);
}

// Sums over the free runs of one horizon.
struct FreeRunSums {
  SumsByVelocity of_model;
  SumsByVelocity of_constant_velocity;
  double squared_distance_m2 = 0.0;
  std::size_t windows = 0;
};

double SquaredDistance(const Eta& a, const Eta& b) {
  const double north = ErrorOf(a.x_m, b.x_m);
  const double east = ErrorOf(a.y_m, b.y_m);
  return north * north + east * east;
}

/// Adds the run predicted from row `first` on; Predicted has a pose and a velocity.
template <class Predicted>
void AddRun(const PreparedDataset& dataset, const std::vector<Predicted>& run, std::size_t first,
            FreeRunSums& sums) {
  for (std::size_t k = 1; k < run.size(); ++k) {
    Add(sums.of_model, dataset.rows[first + k].nu, run[k].nu);
    Add(sums.of_constant_velocity, dataset.rows[first + k].nu, dataset.rows[first].nu);
  }
  sums.squared_distance_m2 +=
      SquaredDistance(dataset.rows[first + run.size() - 1].eta, run.back().eta);
  ++sums.windows;
}

FreeRunScores ScoresOf(const FreeRunSums& sums, const PreparedDataset& dataset, double horizon_s) {
  FreeRunScores scores;
  scores.horizon_s = horizon_s;
  scores.windows = sums.windows;
  if (sums.windows == 0) return scores;
  const Velocity noise = ToArray(dataset.nu_noise);
  for (std::size_t j = 0; j < scores.velocity.size(); ++j) {
    scores.velocity[j] = {sums.of_model[j].Rmse(), sums.of_model[j].Mae(), sums.of_model[j].R2(),
                          sums.of_constant_velocity[j].Rmse(), noise[j]};
  }
  scores.position_rmse_m = std::sqrt(sums.squared_distance_m2 / static_cast<double>(sums.windows));
  return scores;
}

FreeRunScores ScoreFreeRuns(const PreparedDataset& dataset, const VesselModel& model,
                            const ThrustHistory& thrust, double horizon_s) {
  const auto steps = static_cast<std::size_t>(std::lround(horizon_s / dataset.sampling_period_s));
  FreeRunSums sums;
  for (const std::size_t first : FreeRunStarts(dataset, steps)) {
    AddRun(dataset, RunFreely(dataset, model, thrust, first, steps), first, sums);
  }
  return ScoresOf(sums, dataset, horizon_s);
}

/// Free runs of a model with effects along a dataset, from measured states.
class AugmentedFreeRuns {
 public:
  AugmentedFreeRuns(const PreparedDataset& dataset, const AugmentedModel& model)
      : dataset_(dataset),
        boat_(model, RecordingFrameOf(dataset), dataset.hull),
        steps_(StepsPerRow(model.model, dataset.sampling_period_s)),
        step_s_(dataset.sampling_period_s / static_cast<double>(steps_)) {}

  /// Calls visit(first row, predicted rows from it on) for every run of `rows` periods.
  template <class Visit>
  void RunAll(std::size_t rows, Visit visit) const {
    for (std::size_t s = 0; s < dataset_.segments.size(); ++s) {
      const RowRange& segment = dataset_.segments[s];
      if (segment.size() < 2) continue;
      const double start_s = dataset_.rows[segment.begin].time_s;
      const auto drives =
          boat_.DrivesAlong(dataset_.commands[s], start_s, step_s_, segment.size() * steps_);
      for (const std::size_t k : FreeRunStarts(segment, rows)) {
        visit(k, Run(segment, k, rows, drives));
      }
    }
  }

 private:
  std::vector<PreparedRow> Run(const RowRange& segment, std::size_t first, std::size_t rows,
                               const std::vector<Drive>& drives) const {
    const double from_s = dataset_.rows[first].time_s;
    const auto ahead = std::span(drives).subspan((first - segment.begin) * steps_, rows * steps_);
    const std::vector<Pose> track =
        boat_.Simulate(TrueStart(dataset_, segment, from_s, boat_), ahead, from_s, step_s_);
    std::vector<PreparedRow> predicted;
    for (std::size_t k = 0; k <= rows; ++k) {
      const Pose& now = track[k * steps_];
      const auto late =
          static_cast<std::size_t>(std::lround(std::max(boat_.LatencyS(), 0.0) / step_s_));
      const Pose& past = track[k * steps_ - std::min(late, k * steps_)];
      const Pose measured = MeasuredPose(now, past, dataset_.sensors.antenna, boat_);
      PreparedRow row;
      row.eta = measured.eta;
      row.nu = measured.nu;
      predicted.push_back(row);
    }
    return predicted;
  }

  const PreparedDataset& dataset_;
  AugmentedBoat boat_;
  std::size_t steps_;
  double step_s_;
};

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

  /// Calls visit(first row, predicted rows from it on) for every run of `rows` periods.
  template <class Visit>
  void RunAll(std::size_t rows, Visit visit) const {
    for (const std::size_t first : FreeRunStarts(dataset_, rows)) {
      std::vector<PreparedRow> predicted;
      for (const VesselState& state : RunFreely(dataset_, model_, thrust_, first, rows)) {
        PreparedRow row;
        row.eta = state.eta;
        row.nu = state.nu;
        predicted.push_back(row);
      }
      visit(first, predicted);
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
  const long rows = std::lround(horizon_s / dataset.sampling_period_s);
  std::vector<FreeRun> runs;
  free_runs.RunAll(static_cast<std::size_t>(rows),
                   [&](std::size_t first, std::vector<PreparedRow> predicted) {
                     for (std::size_t k = 0; k < predicted.size(); ++k) {
                       predicted[k].time_s = dataset.rows[first + k].time_s;
                     }
                     runs.push_back({first, std::move(predicted)});
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
  SumsByVelocity of_model;
  SumsByVelocity of_constant_velocity;
  free_runs.RunAll(1, [&](std::size_t first, const std::vector<PreparedRow>& predicted) {
    Add(of_model, dataset.rows[first + 1].nu, predicted[1].nu);
    Add(of_constant_velocity, dataset.rows[first + 1].nu, dataset.rows[first].nu);
  });
  return OneStepScoresOf(of_model, of_constant_velocity);
}

template <class FreeRuns>
FreeRunScores ScoresOfHorizon(const PreparedDataset& dataset, const FreeRuns& free_runs,
                              double horizon_s) {
  const auto steps = static_cast<std::size_t>(std::lround(horizon_s / dataset.sampling_period_s));
  FreeRunSums sums;
  free_runs.RunAll(steps, [&](std::size_t first, const std::vector<PreparedRow>& predicted) {
    AddRun(dataset, predicted, first, sums);
  });
  return ScoresOf(sums, dataset, horizon_s);
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

bool Diverges(const FreeRunScores& scores, const Nu& limits) {
  const std::array<double, 3> limit = {limits.u, limits.v, limits.r};
  for (std::size_t i = 0; i < limit.size(); ++i) {
    if (!(scores.velocity[i].rmse < limit[i])) return true;  // NaN and infinity too
  }
  return false;
}

Result<Metrics> Validate(const PreparedDataset& dataset, const VesselModel& model,
                         const ValidationOptions& options) {
  if (auto refusal = RefuseUnanswerable(dataset, model, options)) {
    return tl::unexpected<Refusal>(*std::move(refusal));
  }
  Metrics metrics;
  const ThrustHistory thrust = FollowThrust(dataset, model);
  metrics.one_step = ScoreOneStep(dataset, model, thrust);
  for (const double horizon_s : options.horizons_s) {
    metrics.free_run.push_back(ScoreFreeRuns(dataset, model, thrust, horizon_s));
  }
  return metrics;
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
  return ScoreFreeRuns(dataset, *model, FollowThrust(dataset, *model), horizon_s);
}

}  // namespace telltale
