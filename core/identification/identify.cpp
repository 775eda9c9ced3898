#include "identification/identify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "estimation/one_step.hpp"
#include "uncertainty/segment_bootstrap.hpp"

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// With fewer independent segments than this a bootstrap over them says little.
constexpr std::size_t kFewestSegments = 8;

/// Everything known about the three equations before coefficients are written down.
struct Answers {
  std::array<std::optional<Excitation>, 3> excitations;
  std::array<std::optional<EquationEstimate>, 3> estimates;
  std::vector<Refusal> refusals;

  bool Any() const {
    return std::any_of(estimates.begin(), estimates.end(), [](const auto& e) { return e; });
  }
};

/// Bounds of the coefficients of all estimates, stacked in the order of the bootstrap.
struct Bounds {
  Eigen::MatrixXd covariance;
  std::vector<Interval> intervals;
};

Answers Answer(const RegressionProblem& problem, const ExcitationLimits& limits) {
  Answers answers;
  for (const Equation equation : kEquations) {
    const EquationProblem& regression = problem.equations[IndexOf(equation)];
    const auto excitation = Assess(regression, limits);
    if (!excitation) {
      answers.refusals.push_back(excitation.error());
      continue;
    }
    for (const CollinearGroup& group : excitation->collinear) {
      answers.refusals.push_back(Explain(group, regression));
    }
    answers.estimates[IndexOf(equation)] = EstimateOneStep(*excitation);
    answers.excitations[IndexOf(equation)] = *excitation;
  }
  return answers;
}

Bounds ResidualBounds(const Answers& answers, double level) {
  Eigen::Index size = 0;
  for (const auto& estimate : answers.estimates) size += estimate ? estimate->theta.size() : 0;
  Bounds bounds;
  bounds.covariance = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index first = 0;
  for (const auto& estimate : answers.estimates) {
    if (!estimate) continue;
    const Eigen::Index p = estimate->theta.size();
    auto block = bounds.covariance.block(first, first, p, p);
    block = estimate->residual_variance * estimate->basis * estimate->basis.transpose();
    for (Eigen::Index j = 0; j < p; ++j) {
      bounds.intervals.push_back(StudentInterval(estimate->theta[j], std::sqrt(block(j, j)),
                                                 estimate->degrees_of_freedom, level));
    }
    first += p;
  }
  return bounds;
}

Bounds ReplicateBounds(const BootstrapReplicates& replicates, double level) {
  Bounds bounds;
  bounds.covariance = Covariance(replicates);
  for (Eigen::Index j = 0; j < replicates.theta.rows(); ++j) {
    const Eigen::VectorXd row = replicates.theta.row(j);
    bounds.intervals.push_back(
        PercentileInterval({row.data(), static_cast<std::size_t>(row.size())}, level));
  }
  return bounds;
}

std::size_t SegmentsWithRows(const EquationProblem& problem) {
  return static_cast<std::size_t>(std::count_if(problem.clusters.begin(), problem.clusters.end(),
                                                [](const RowRange& c) { return c.size() > 0; }));
}

std::optional<Refusal> WarnOfFewSegments(const RegressionProblem& problem, const Answers& answers) {
  std::size_t fewest = problem.equations[0].clusters.size();
  for (const EquationProblem& equation : problem.equations) {
    if (answers.estimates[IndexOf(equation.equation)]) {
      fewest = std::min(fewest, SegmentsWithRows(equation));
    }
  }
  if (fewest >= kFewestSegments) return std::nullopt;
  return Refusal{"bounds",
                 "rest on only " + std::to_string(fewest) + " independent segments, " +
                     std::to_string(kFewestSegments) + " are needed to trust them",
                 "record for longer, with more changes of manoeuvre"};
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

Coefficient Unanswered(Equation equation, const Regressor& regressor, CoefficientStatus status,
                       double estimate, double level) {
  Coefficient coefficient;
  coefficient.equation = equation;
  coefficient.regressor = regressor.name;
  coefficient.symbol = regressor.symbol;
  coefficient.unit = regressor.unit;
  coefficient.status = status;
  coefficient.estimate = estimate;
  coefficient.standard_error = kInfinity;
  coefficient.interval = Unbounded(level);
  return coefficient;
}

/// Writes one equation's coefficients, and where each stands in the stacked bounds (-1: nowhere).
void WriteEquation(const EquationProblem& problem, const EquationEstimate& estimate,
                   const Excitation& excitation, const Bounds& bounds, Eigen::Index first,
                   double level, std::vector<Coefficient>& coefficients,
                   std::vector<Eigen::Index>& places) {
  for (std::size_t column = 0; column < problem.regressors.size(); ++column) {
    const Regressor& regressor = problem.regressors[column];
    const auto found = std::find(estimate.columns.begin(), estimate.columns.end(), column);
    if (found == estimate.columns.end()) {
      coefficients.push_back(Unanswered(problem.equation, regressor,
                                        CoefficientStatus::kNotExcited, 0.0, level));
      places.push_back(-1);
      continue;
    }
    const auto j = found - estimate.columns.begin();
    if (!estimate.estimable[static_cast<std::size_t>(j)]) {
      coefficients.push_back(Unanswered(problem.equation, regressor, CoefficientStatus::kCollinear,
                                        estimate.theta[j], level));
      places.push_back(-1);
      continue;
    }
    Coefficient coefficient = Unanswered(
        problem.equation, regressor,
        IsCollinear(excitation, column) ? CoefficientStatus::kCollinear
                                        : CoefficientStatus::kEstimated,
        estimate.theta[j], level);
    coefficient.standard_error = std::sqrt(bounds.covariance(first + j, first + j));
    coefficient.interval = bounds.intervals[static_cast<std::size_t>(first + j)];
    coefficients.push_back(coefficient);
    places.push_back(first + j);
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

void WriteCoefficients(const RegressionProblem& problem, const Answers& answers,
                       const Bounds& bounds, double level, Identification& identification) {
  std::vector<Eigen::Index> places;
  Eigen::Index first = 0;
  for (std::size_t j = 0; j < answers.estimates.size(); ++j) {
    if (!answers.estimates[j]) continue;
    WriteEquation(problem.equations[j], *answers.estimates[j], *answers.excitations[j], bounds,
                  first, level, identification.coefficients, places);
    first += answers.estimates[j]->theta.size();
  }
  identification.covariance = SpreadCovariance(bounds.covariance, places);
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

std::optional<Refusal> OptionRefusal(const char* field, const std::string& value,
                                     const char* allowed) {
  return Refusal{field, "is " + value, std::string("choose a value in ") + allowed};
}

}  // namespace

std::optional<Refusal> IdentifyOptions::Validate() const {
  if (auto refusal = prepare.Validate()) return refusal;
  if (auto refusal = excitation.Validate()) return refusal;
  if (regression.structure != Structure::kStaticQuadratic) {
    return Refusal{"structure", "is " + std::string(Name(regression.structure)),
                   "choose STATIC_QUADRATIC"};
  }
  if (regression.parameterization == Parameterization::kUnknown) {
    return Refusal{"parameterization", "is unset", "choose PROPELLER or PAPER"};
  }
  if (estimator != Estimator::kOneStep) {
    return Refusal{"estimator", "is " + std::string(Name(estimator)), "choose ONE_STEP"};
  }
  if (!(interval_level >= 0.5 && interval_level <= 0.999)) {
    return OptionRefusal("interval_level", std::to_string(interval_level), "[0.5, 0.999]");
  }
  if (bootstrap_replicates != 0 &&
      (bootstrap_replicates < 100 || bootstrap_replicates > 100000)) {
    return OptionRefusal("bootstrap_replicates", std::to_string(bootstrap_replicates),
                         "[100, 100000], or 0 for none");
  }
  if (threads < 1 || threads > 256) {
    return OptionRefusal("threads", std::to_string(threads), "[1, 256]");
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
  report("building regressions", 0.3);
  const RegressionProblem problem = BuildRegression(dataset, options.regression);
  report("estimating", 0.4);
  Answers answers = Answer(problem, options.excitation);
  if (!answers.Any()) return tl::unexpected(NothingAnswered(answers.refusals));

  Identification identification;
  Bounds bounds;
  if (options.bootstrap_replicates > 0) {
    report("bootstrapping", 0.5);
    const BootstrapReplicates replicates = BootstrapSegments(
        problem, answers.estimates,
        {options.bootstrap_replicates, options.seed, options.threads});
    if (replicates.theta.cols() < 2) {
      return Refuse("bounds", "no bootstrap replicate could be solved",
                    "record for longer, or ask for bounds from residuals with 0 replicates");
    }
    bounds = ReplicateBounds(replicates, options.interval_level);
    identification.provenance.bootstrap_failures = replicates.failures;
    identification.provenance.bounds_basis =
        "segment bootstrap, percentile intervals; attenuation of one-step least squares by noisy "
        "velocities is not covered";
    if (auto warning = WarnOfFewSegments(problem, answers)) answers.refusals.push_back(*warning);
    if (auto warning = WarnOfFailures(replicates)) answers.refusals.push_back(*warning);
  } else {
    bounds = ResidualBounds(answers, options.interval_level);
    identification.provenance.bounds_basis =
        "residual covariance, white residuals assumed; too narrow where residuals are coloured or "
        "velocities noisy";
  }

  identification.vehicle_id = vehicle_id;
  identification.structure = problem.structure;
  identification.parameterization = problem.parameterization;
  identification.estimator = options.estimator;
  identification.sampling_period_s = problem.sampling_period_s;
  WriteCoefficients(problem, answers, bounds, options.interval_level, identification);
  identification.window = Summarise(dataset);
  identification.refusals = std::move(answers.refusals);
  identification.provenance.preset = Name(options.prepare.preset);
  identification.provenance.bootstrap_replicates = options.bootstrap_replicates;
  identification.provenance.seed = options.seed;
  identification.provenance.software_version = TELLTALE_VERSION;
  report("done", 1.0);
  return identification;
}

}  // namespace telltale
