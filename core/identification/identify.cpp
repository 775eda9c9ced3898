#include "identification/identify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "estimation/dead_zone.hpp"
#include "estimation/lagged_regression.hpp"
#include "estimation/one_step.hpp"
#include "range.hpp"
#include "uncertainty/bootstrap.hpp"
#include "uncertainty/clustered_fit.hpp"

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// With fewer independent segments or blocks than this a bootstrap over them says little.
constexpr std::size_t kFewestUnits = 8;

/// Everything known about the equations before coefficients are written down.
/// Theta of answered equation j begins at place first[j] of the stacked fits.
struct Answers {
  std::array<EquationProblem, 3> equations;  ///< of the static structure
  std::array<std::optional<Excitation>, 3> excitations;
  std::array<std::optional<EquationEstimate>, 3> estimates;
  std::array<Eigen::Index, 3> first{};
  std::optional<LaggedEstimate> lag;
  std::vector<Refusal> refusals;

  bool Any() const {
    return std::any_of(excitations.begin(), excitations.end(), [](const auto& e) { return e; });
  }
};

/// Bounds of all stacked coefficients.
struct Bounds {
  double degrees_of_freedom = 0.0;  ///< of the first fit
  Eigen::MatrixXd covariance;
  std::vector<Interval> intervals;
  std::vector<bool> estimable;
};

void AssessEquation(const EquationProblem& regression, const ExcitationLimits& limits,
                    Answers& answers) {
  const auto excitation = Assess(regression, limits);
  if (!excitation) {
    answers.refusals.push_back(excitation.error());
    return;
  }
  for (const CollinearGroup& group : excitation->collinear) {
    answers.refusals.push_back(Explain(group, regression));
  }
  answers.excitations[IndexOf(regression.equation)] = *excitation;
}

Refusal CannotTell(const char* side, const DeadZoneLimit& limit, double kept) {
  const std::string reason = limit.contrast > kLeastContrast
                                 ? "the best value lies at the edge of the allowed range, so it "
                                   "stands for something else"
                                 : "the data cannot tell: every value allowed explains them alike";
  return {"dead zone, " + std::string(side), reason + "; " + std::to_string(kept) + " is kept",
          "record commands that pass slowly through neutral on this side, or give the limit"};
}

/// What the data say of the dead zone; a limit they say nothing of stays as given, with a refusal.
DeadZone IdentifyDeadZone(const PreparedDataset& dataset, const IdentifyOptions& options,
                          std::vector<Refusal>& refusals) {
  DeadZone limits = options.regression.dead_zone;
  const auto estimate =
      EstimateDeadZone(dataset, options.regression, options.excitation, options.threads);
  if (!estimate) return limits;  // the equations are refused next, for the same reason
  if (estimate->forward.determined) {
    limits.forward = estimate->forward.estimate;
  } else {
    refusals.push_back(CannotTell("forward", estimate->forward, limits.forward));
  }
  if (estimate->reverse.determined) {
    limits.reverse = estimate->reverse.estimate;
  } else {
    refusals.push_back(CannotTell("reverse", estimate->reverse, limits.reverse));
  }
  return limits;
}

Answers AnswerStatic(const PreparedDataset& dataset, const RegressionOptions& regression,
                     const ExcitationLimits& limits) {
  Answers answers;
  answers.equations = BuildRegression(dataset, regression).equations;
  Eigen::Index next = 0;
  for (std::size_t j = 0; j < answers.equations.size(); ++j) {
    AssessEquation(answers.equations[j], limits, answers);
    if (!answers.excitations[j]) continue;
    answers.estimates[j] = EstimateOneStep(*answers.excitations[j]);
    answers.first[j] = next;
    next += answers.estimates[j]->theta.size();
  }
  return answers;
}

Answers AnswerDynamic(const PreparedDataset& dataset, const RegressionOptions& regression,
                      const ExcitationLimits& limits) {
  const LaggedProblem problem = BuildLagged(dataset, regression);
  Answers answers;
  for (const EquationProblem& equation : problem.at_once.equations) {
    AssessEquation(equation, limits, answers);
  }
  if (!answers.Any()) return answers;
  answers.lag = EstimateLagged(problem, answers.excitations);
  answers.estimates = answers.lag->equations;
  Eigen::Index next = 1;  // the time constant comes first
  for (std::size_t j = 0; j < answers.estimates.size(); ++j) {
    if (!answers.estimates[j]) continue;
    answers.first[j] = next;
    next += answers.estimates[j]->theta.size();
  }
  return answers;
}

Answers Answer(const PreparedDataset& dataset, const RegressionOptions& regression,
               const ExcitationLimits& limits) {
  return regression.structure == Structure::kFirstOrderDynamic
             ? AnswerDynamic(dataset, regression, limits)
             : AnswerStatic(dataset, regression, limits);
}

/// What bounds are made from.
std::vector<ClusteredFit> FitsOf(const Answers& answers) {
  if (answers.lag) return {FitOf(*answers.lag)};
  std::vector<ClusteredFit> fits;
  for (std::size_t j = 0; j < answers.estimates.size(); ++j) {
    if (answers.estimates[j]) fits.push_back(FitOf(answers.equations[j], *answers.estimates[j]));
  }
  return fits;
}

Bounds BoundsFor(const std::vector<ClusteredFit>& fits) {
  Bounds bounds;
  Eigen::Index size = 0;
  for (const ClusteredFit& fit : fits) {
    size += fit.theta.size();
    bounds.estimable.insert(bounds.estimable.end(), fit.estimable.begin(), fit.estimable.end());
  }
  bounds.covariance = Eigen::MatrixXd::Zero(size, size);
  bounds.degrees_of_freedom = fits.front().degrees_of_freedom;
  return bounds;
}

Bounds ResidualBounds(const std::vector<ClusteredFit>& fits, double level) {
  Bounds bounds = BoundsFor(fits);
  Eigen::Index first = 0;
  for (const ClusteredFit& fit : fits) {
    const Eigen::Index p = fit.theta.size();
    auto block = bounds.covariance.block(first, first, p, p);
    block = ResidualCovariance(fit);
    for (Eigen::Index j = 0; j < p; ++j) {
      bounds.intervals.push_back(
          StudentInterval(fit.theta[j], std::sqrt(block(j, j)), fit.degrees_of_freedom, level));
    }
    first += p;
  }
  return bounds;
}

Bounds ReplicateBounds(const std::vector<ClusteredFit>& fits, const BootstrapReplicates& replicates,
                       IntervalMethod method, double level) {
  Bounds bounds = BoundsFor(fits);
  bounds.covariance = Covariance(replicates);
  bounds.intervals = Intervals(replicates, method, level);
  return bounds;
}

std::size_t SegmentsWithRows(const ClusteredFit& fit) {
  return static_cast<std::size_t>(std::count_if(fit.clusters.begin(), fit.clusters.end(),
                                                [](const RowRange& c) { return c.size() > 0; }));
}

std::optional<Refusal> WarnOfFewUnits(const std::vector<ClusteredFit>& fits,
                                      const BootstrapReplicates& replicates) {
  const bool blocks = replicates.block_length > 0;
  std::size_t fewest = replicates.draws;
  if (!blocks) {
    for (const ClusteredFit& fit : fits) fewest = std::min(fewest, SegmentsWithRows(fit));
  }
  if (fewest >= kFewestUnits) return std::nullopt;
  return Refusal{"bounds",
                 "rest on only " + std::to_string(fewest) + " independent " +
                     (blocks ? "blocks, " : "segments, ") + std::to_string(kFewestUnits) +
                     " are needed to trust them",
                 "record for longer, with more changes of manoeuvre"};
}

std::string InWords(const BootstrapReplicates& replicates, double sampling_period_s) {
  if (replicates.block_length == 0) return "segment bootstrap";
  std::ostringstream words;
  words << "moving-block bootstrap, blocks of " << replicates.block_length << " rows ("
        << static_cast<double>(replicates.block_length) * sampling_period_s << " s)";
  return words.str();
}

std::string InWords(IntervalMethod method) {
  switch (method) {
    case IntervalMethod::kStudentized: return "studentized intervals";
    case IntervalMethod::kBca: return "bias-corrected and accelerated (BCa) intervals";
    case IntervalMethod::kPercentile:
    case IntervalMethod::kUnknown: break;
  }
  return "percentile intervals";
}

std::optional<Refusal> WarnOfFailures(const BootstrapReplicates& replicates) {
  const auto solved = static_cast<std::size_t>(replicates.theta.cols());
  // Losing one draw in twenty at random still leaves a 95 % interval what it says it is.
  if (replicates.failures * 20 <= solved) return std::nullopt;
  return Refusal{"bounds",
                 std::to_string(replicates.failures) + " of " +
                     std::to_string(replicates.failures + solved) +
                     " bootstrap draws could not be solved: some coefficient rests on a handful of "
                     "segments",
                 "repeat the manoeuvres that occur only once or twice"};
}

bool IsCollinear(const Excitation& excitation, std::size_t column) {
  return std::any_of(excitation.collinear.begin(), excitation.collinear.end(), [&](const auto& g) {
    return std::find(g.columns.begin(), g.columns.end(), column) != g.columns.end();
  });
}

/// A coefficient as long as nothing is known of it.
Coefficient Unanswered(Equation equation, const Regressor& regressor, double level) {
  Coefficient coefficient;
  coefficient.equation = equation;
  coefficient.regressor = regressor.name;
  coefficient.symbol = regressor.symbol;
  coefficient.unit = regressor.unit;
  coefficient.status = CoefficientStatus::kNotExcited;
  coefficient.standard_error = kInfinity;
  coefficient.interval = Unbounded(level);
  return coefficient;
}

/// Writes the coefficients of answered equation j, and where each stands in the stacked bounds (-1:
/// nowhere).
void WriteEquation(std::size_t j, const Answers& answers, const Bounds& bounds,
                   Identification& identification, std::vector<Eigen::Index>& places) {
  const Excitation& excitation = *answers.excitations[j];
  const EquationEstimate& estimate = *answers.estimates[j];
  const double level = bounds.intervals.front().level;
  const auto regressors = Regressors(excitation.equation, identification.parameterization);
  for (std::size_t column = 0; column < regressors.size(); ++column) {
    Coefficient coefficient = Unanswered(excitation.equation, regressors[column], level);
    Eigen::Index place = -1;
    const auto found = std::find(estimate.columns.begin(), estimate.columns.end(), column);
    if (found != estimate.columns.end()) {
      const Eigen::Index position = found - estimate.columns.begin();
      place = answers.first[j] + position;
      coefficient.estimate = estimate.theta[position];
      coefficient.status = IsCollinear(excitation, column) ? CoefficientStatus::kCollinear
                                                           : CoefficientStatus::kEstimated;
      if (bounds.estimable[static_cast<std::size_t>(place)]) {
        coefficient.standard_error = std::sqrt(bounds.covariance(place, place));
        coefficient.interval = bounds.intervals[static_cast<std::size_t>(place)];
      } else {
        coefficient.status = CoefficientStatus::kCollinear;
        place = -1;
      }
    }
    identification.coefficients.push_back(coefficient);
    places.push_back(place);
  }
}

Eigen::MatrixXd SpreadCovariance(const Eigen::MatrixXd& stacked,
                                 const std::vector<Eigen::Index>& places) {
  const auto size = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Index from = places[static_cast<std::size_t>(i)];
    if (from < 0) {
      covariance(i, i) = kInfinity;
      continue;
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      const Eigen::Index to = places[static_cast<std::size_t>(j)];
      if (to >= 0) covariance(i, j) = stacked(from, to);
    }
  }
  return covariance;
}

/// A time constant below zero is none. Where no lag is seen the replicates, linearised about that
/// end, say nothing of how long a lag could hide; the standard error does.
Coefficient WriteTimeConstant(const Answers& answers, const Bounds& bounds) {
  const LaggedEstimate& lag = *answers.lag;
  const Interval& interval = bounds.intervals.front();
  Coefficient coefficient;
  coefficient.symbol = "tau";
  coefficient.unit = "s";
  coefficient.status = CoefficientStatus::kEstimated;
  coefficient.estimate = lag.time_constant_s;
  coefficient.standard_error = std::sqrt(bounds.covariance(0, 0));
  coefficient.interval = {interval.level, std::max(interval.lower, 0.0), interval.upper};
  if (lag.no_lag_seen) {
    coefficient.interval = {interval.level, 0.0,
                            StudentInterval(lag.time_constant_s, coefficient.standard_error,
                                            bounds.degrees_of_freedom, interval.level)
                                .upper};
  }
  return coefficient;
}

/// Of the time constant, first in the stacked bounds, with each coefficient.
Eigen::VectorXd SpreadTimeConstantCovariance(const Eigen::MatrixXd& stacked,
                                             const std::vector<Eigen::Index>& places) {
  Eigen::VectorXd covariance = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(places.size()));
  for (Eigen::Index i = 0; i < covariance.size(); ++i) {
    const Eigen::Index place = places[static_cast<std::size_t>(i)];
    if (place >= 0) covariance[i] = stacked(0, place);
  }
  return covariance;
}

void WriteCoefficients(const Answers& answers, const Bounds& bounds,
                       Identification& identification) {
  std::vector<Eigen::Index> places;
  for (std::size_t j = 0; j < answers.estimates.size(); ++j) {
    if (answers.estimates[j]) WriteEquation(j, answers, bounds, identification, places);
  }
  identification.covariance = SpreadCovariance(bounds.covariance, places);
  if (!answers.lag) return;
  identification.thruster_time_constant = WriteTimeConstant(answers, bounds);
  identification.time_constant_covariance = SpreadTimeConstantCovariance(bounds.covariance, places);
}

WindowSummary Summarise(const PreparedDataset& dataset) {
  return {dataset.StartTime(), dataset.EndTime(), dataset.rows.size(), dataset.segments.size(),
          dataset.rejected};
}

Refusal NothingAnswered(const std::vector<Refusal>& refusals) {
  std::string reasons;
  for (const Refusal& refusal : refusals) {
    reasons += (reasons.empty() ? "" : "; ") + refusal.subject + ": " + refusal.reason;
  }
  return {"model", "not one equation can be answered (" + reasons + ")",
          refusals.empty() ? "record for longer" : refusals.front().advice};
}

constexpr const char* kSubject = "identification";

std::optional<Refusal> ReplicatesRefusal(std::size_t replicates) {
  if (replicates == 0) return std::nullopt;
  auto refusal = OutOfRange(kSubject, "bootstrap_replicates", static_cast<double>(replicates),
                            100.0, 100000.0);
  if (refusal) refusal->advice += ", or to 0 for none";
  return refusal;
}

std::optional<Refusal> LimitRefusal(const DeadZone& limits) {
  if (auto refusal = OutOfRange("dead_zone", "forward", limits.forward, 0.0, kWidestDeadZone)) {
    return refusal;
  }
  return OutOfRange("dead_zone", "reverse", limits.reverse, -kWidestDeadZone, 0.0);
}

}  // namespace

std::string_view Name(DeadZoneSource source) {
  switch (source) {
    case DeadZoneSource::kGiven: return "GIVEN";
    case DeadZoneSource::kIdentified: return "IDENTIFIED";
    case DeadZoneSource::kUnknown: break;
  }
  return "UNKNOWN";
}

std::optional<Refusal> IdentifyOptions::Validate() const {
  if (auto refusal = prepare.Validate()) return refusal;
  if (auto refusal = excitation.Validate()) return refusal;
  if (regression.structure == Structure::kUnknown) {
    return Refusal{"structure", "is unset", "choose STATIC_QUADRATIC or FIRST_ORDER_DYNAMIC"};
  }
  if (regression.parameterization == Parameterization::kUnknown) {
    return Refusal{"parameterization", "is unset", "choose PROPELLER or PAPER"};
  }
  if (dead_zone_source == DeadZoneSource::kUnknown) {
    return Refusal{"dead_zone_source", "is unset", "choose GIVEN or IDENTIFIED"};
  }
  if (auto refusal = LimitRefusal(regression.dead_zone)) return refusal;
  if (estimator != Estimator::kOneStep) {
    return Refusal{"estimator", "is " + std::string(Name(estimator)), "choose ONE_STEP"};
  }
  if (auto refusal = OutOfRange(kSubject, "interval_level", interval_level, 0.5, 0.999)) {
    return refusal;
  }
  if (auto refusal = ReplicatesRefusal(bootstrap_replicates)) return refusal;
  if (resampling == Resampling::kUnknown) {
    return Refusal{"resampling", "is unset", "choose SEGMENTS or MOVING_BLOCKS"};
  }
  if (interval_method == IntervalMethod::kUnknown) {
    return Refusal{"interval_method", "is unset", "choose PERCENTILE, STUDENTIZED or BCA"};
  }
  if (auto refusal = OutOfRange(kSubject, "threads", static_cast<double>(threads), 1.0, 256.0)) {
    return refusal;
  }
  return std::nullopt;
}

Result<Identification> Identify(const Recording& recording, const Vehicle& vehicle,
                                const IdentifyOptions& options, const Progress& progress) {
  if (auto refusal = options.Validate()) return tl::unexpected(*refusal);
  if (progress) progress("preparing data", 0.0);
  const auto dataset = Prepare(recording, vehicle, options.prepare);
  if (!dataset) return tl::unexpected(dataset.error());
  return Identify(*dataset, vehicle.vehicle_id, options, progress);
}

Result<Identification> Identify(const PreparedDataset& dataset, const std::string& vehicle_id,
                                const IdentifyOptions& options, const Progress& progress) {
  if (auto refusal = options.Validate()) return tl::unexpected(*refusal);
  const auto report = [&](std::string_view stage, double fraction) {
    if (progress) progress(stage, fraction);
  };
  const bool seek_dead_zone = options.dead_zone_source == DeadZoneSource::kIdentified;
  RegressionOptions regression = options.regression;
  std::vector<Refusal> dead_zone_refusals;
  if (seek_dead_zone) {
    report("identifying the dead zone", 0.1);
    regression.dead_zone = IdentifyDeadZone(dataset, options, dead_zone_refusals);
  }
  report("estimating", 0.3);
  Answers answers = Answer(dataset, regression, options.excitation);
  if (!answers.Any()) return tl::unexpected(NothingAnswered(answers.refusals));
  answers.refusals.insert(answers.refusals.end(), dead_zone_refusals.begin(),
                          dead_zone_refusals.end());

  Identification identification;
  const std::vector<ClusteredFit> fits = FitsOf(answers);
  Bounds bounds;
  if (options.bootstrap_replicates > 0) {
    report("bootstrapping", 0.5);
    const BootstrapReplicates replicates =
        Bootstrap(fits, {options.bootstrap_replicates, options.seed, options.threads,
                         options.resampling, options.interval_method});
    if (replicates.theta.cols() < 2) {
      return Refuse("bounds", "no bootstrap replicate could be solved",
                    "record for longer, or ask for bounds from residuals with 0 replicates");
    }
    if (auto warning = WarnOfFewUnits(fits, replicates)) {
      answers.refusals.push_back(*warning);
    }
    if (auto warning = WarnOfFailures(replicates)) answers.refusals.push_back(*warning);
    identification.provenance.bootstrap_failures = replicates.failures;
    identification.provenance.bounds_basis =
        InWords(replicates, dataset.sampling_period_s) + ", " + InWords(options.interval_method) +
        "; attenuation of one-step least squares by noisy velocities is not covered";
    bounds = ReplicateBounds(fits, replicates, options.interval_method, options.interval_level);
  } else {
    bounds = ResidualBounds(fits, options.interval_level);
    identification.provenance.bounds_basis =
        "residual covariance, white residuals assumed; too narrow where residuals are coloured or "
        "velocities noisy";
  }

  if (seek_dead_zone) {
    identification.provenance.bounds_basis +=
        "; identified limits of the dead zone are taken as known";
  }
  identification.vehicle_id = vehicle_id;
  identification.structure = options.regression.structure;
  identification.parameterization = options.regression.parameterization;
  identification.estimator = options.estimator;
  identification.sampling_period_s = dataset.sampling_period_s;
  identification.dead_zone = regression.dead_zone;
  WriteCoefficients(answers, bounds, identification);
  identification.window = Summarise(dataset);
  identification.refusals = std::move(answers.refusals);
  identification.provenance.preset = Name(options.prepare.preset);
  identification.provenance.bootstrap_replicates = options.bootstrap_replicates;
  identification.provenance.seed = options.seed;
  identification.provenance.software_version = TELLTALE_VERSION;
  report("done", 1.0);
  return identification;
}

Result<VesselModel> EstimateModel(const PreparedDataset& dataset,
                                  const RegressionOptions& regression,
                                  const ExcitationLimits& limits) {
  const Answers answers = Answer(dataset, regression, limits);
  VesselModel model;
  model.structure = regression.structure;
  model.parameterization = regression.parameterization;
  model.discretisation = Discretisation::kForwardEuler;
  model.sampling_period_s = dataset.sampling_period_s;
  model.dead_zone = regression.dead_zone;
  for (const Equation equation : kEquations) {
    const auto& estimate = answers.estimates[IndexOf(equation)];
    if (!estimate) {
      return Refuse(std::string(Name(equation)), "the data cannot answer this equation",
                    answers.refusals.front().advice);
    }
    const auto regressors = Regressors(equation, regression.parameterization);
    Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
    theta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(regressors.size()));
    theta(estimate->columns) = estimate->theta;
  }
  if (answers.lag) model.thruster_time_constant_s = answers.lag->time_constant_s;
  return model;
}

}  // namespace telltale
