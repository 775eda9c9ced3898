#include "identification/weak_iv_answer.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "data/preparation.hpp"
#include "estimation/separable_columns.hpp"
#include "estimation/weak_iv.hpp"
#include "uncertainty/twin_correction.hpp"

namespace telltale {
namespace {

constexpr double kLongestPartS = 60.0;

// With fewer clusters than this their scores say little of how the estimate varies.
constexpr std::size_t kFewestClusters = 15;

Answers AssessAll(const PreparedDataset& dataset, RegressionOptions regression,
                  const ExcitationLimits& limits) {
  regression.structure = Structure::kStaticQuadratic;  // excitation does not depend on the lag
  Answers answers;
  for (const EquationProblem& equation : BuildRegression(dataset, regression).equations) {
    AssessEquation(equation, limits, answers);
  }
  return answers;
}

std::array<std::vector<std::size_t>, 3> Sought(const Answers& answers) {
  std::array<std::vector<std::size_t>, 3> columns;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (answers.excitations[j]) columns[j] = answers.excitations[j]->excited;
  }
  return columns;
}

bool Names(const std::vector<Refusal>& refusals, const Refusal& named) {
  return std::any_of(refusals.begin(), refusals.end(),
                     [&](const Refusal& refusal) { return refusal.subject == named.subject; });
}

/// Makes known what had to be cut apart before anything could be estimated.
void TellGroups(const SeparableColumns& separable, Parameterization parameterization,
                Answers& answers) {
  for (const Equation equation : kEquations) {
    EquationProblem names;
    names.equation = equation;
    names.regressors = Regressors(equation, parameterization);
    for (const CollinearGroup& group : separable.groups[IndexOf(equation)]) {
      const Refusal refusal = Explain(group, names);
      answers.excitations[IndexOf(equation)]->collinear.push_back(group);
      if (!Names(answers.refusals, refusal)) answers.refusals.push_back(refusal);
    }
  }
}

/// No coefficient of a dependency that was cut has bounds.
void Unbound(const SeparableColumns& separable, const Answers& answers, Bounds& bounds) {
  for (std::size_t j = 0; j < separable.groups.size(); ++j) {
    for (const CollinearGroup& group : separable.groups[j]) {
      for (const std::size_t column : group.columns) {
        const auto& sought = answers.estimates[j]->columns;
        const auto found = std::find(sought.begin(), sought.end(), column);
        if (found == sought.end()) continue;
        const auto place = static_cast<std::size_t>(answers.first[j] + (found - sought.begin()));
        bounds.estimable[place] = false;
      }
    }
  }
}

/// Splits the stacked unknowns into the answers they are.
void Unstack(const WeakFit& fit, const Eigen::VectorXd& theta, Answers& answers) {
  Eigen::Index next = 0;
  if (fit.time_constant_s) {
    answers.lag = AnsweredLag{std::max(theta[next++], 0.0), LagIsAtItsLeast(fit)};
  }
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const auto size = static_cast<Eigen::Index>(fit.equations[j]->columns.size());
    EquationEstimate estimate;
    estimate.equation = kEquations[j];
    estimate.columns = fit.equations[j]->columns;
    estimate.theta = theta.segment(next, size);
    estimate.estimable.assign(estimate.columns.size(), true);
    answers.first[j] = next;
    answers.estimates[j] = std::move(estimate);
    next += size;
  }
}

void CountWindows(const WeakFit& fit, Answers& answers) {
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    answers.sizes[j] = SizeOf(fit.equations[j]->residual, fit.problem.windows[j].first_rows,
                              fit.problem.phi.stride);
  }
}

Bounds StudentBounds(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                     double degrees_of_freedom, double level) {
  Bounds bounds;
  bounds.degrees_of_freedom = degrees_of_freedom;
  bounds.covariance = covariance;
  bounds.estimable.assign(static_cast<std::size_t>(theta.size()), true);
  for (Eigen::Index j = 0; j < theta.size(); ++j) {
    bounds.intervals.push_back(
        StudentInterval(theta[j], std::sqrt(covariance(j, j)), degrees_of_freedom, level));
  }
  return bounds;
}

Refusal WarnOfFewClusters(Eigen::Index clusters) {
  return {"bounds",
          "rest on only " + std::to_string(clusters) + " independent stretches of time, " +
              std::to_string(kFewestClusters) + " are needed to trust them",
          "record for longer"};
}

Refusal NotCorrected() {
  return {"bounds",
          "fewer than half of the simulated repeats of this data set could be identified again, so "
          "the bias is neither known nor corrected",
          "record for longer, with more varied manoeuvres"};
}

Refusal InstrumentsSayNothing() {
  return {"model",
          "velocities simulated with the model say nothing of those measured, so they cannot "
          "serve as instruments",
          "record more varied manoeuvres for longer, or ask for the one-step estimator"};
}

std::string InWords(const TwinCorrection& corrected, Eigen::Index clusters) {
  std::ostringstream words;
  words.precision(3);
  words << "clusters of residuals (" << clusters << "), bias "
        << (corrected.corrected ? "taken out" : "counted as an uncertainty")
        << " and bounds stretched by " << corrected.calibration << " after " << corrected.solved
        << " simulated repeats of this data set, Student t";
  return words.str();
}

}  // namespace

Result<PreparedDataset> PrepareForWeakIv(const Recording& recording, const Vehicle& vehicle,
                                         const PrepareOptions& options) {
  PrepareOptions chosen = options;
  const auto preview = Prepare(recording, vehicle, chosen);
  if (!preview) return tl::unexpected(preview.error());
  chosen.smoothing_half_width = SmoothingFor(*preview);
  chosen.longest_stretch_s = kLongestPartS;
  return Prepare(recording, vehicle, chosen);
}

Result<BoundedAnswers> BoundWeakIv(const PreparedDataset& dataset,
                                   const RegressionOptions& regression,
                                   const IdentifyOptions& options, const Progress& progress) {
  BoundedAnswers bounded;
  Answers& answers = bounded.answers;
  answers = AssessAll(dataset, regression, options.excitation);
  if (!answers.Any()) return tl::unexpected(NothingAnswered(answers.refusals));
  const SeparableColumns separable =
      Separate(dataset, regression, Sought(answers), options.weak_iv.form);
  TellGroups(separable, regression.parameterization, answers);
  const auto& columns = separable.kept;
  const auto fit = EstimateWeakIv(dataset, regression, columns, options.weak_iv);
  if (!fit || fit->scores.cols() < 2 || !ClusterCovariance(*fit).allFinite()) {
    return tl::unexpected(InstrumentsSayNothing());
  }
  CountWindows(*fit, answers);
  const Eigen::Index clusters = fit->scores.cols();
  if (clusters < static_cast<Eigen::Index>(kFewestClusters)) {
    answers.refusals.push_back(WarnOfFewClusters(clusters));
  }

  std::optional<TwinCorrection> corrected;
  if (options.twins > 0) {
    corrected =
        CorrectWithTwins(dataset, regression, *fit, columns, options.weak_iv,
                         {options.twins, options.seed, options.threads}, [&](double fraction) {
                           if (progress) progress("simulating repeats", 0.4 + 0.55 * fraction);
                         });
    if (corrected && !corrected->covariance.allFinite()) corrected.reset();
    if (!corrected) answers.refusals.push_back(NotCorrected());
  }
  if (corrected) {
    Unstack(*fit, corrected->theta, answers);
    bounded.bounds = StudentBounds(corrected->theta, corrected->covariance,
                                   corrected->degrees_of_freedom, options.interval_level);
    Unbound(separable, answers, bounded.bounds);
    bounded.disturbance = corrected->disturbance;
    bounded.provenance.twins = corrected->solved;
    bounded.provenance.twin_failures = corrected->failures;
    bounded.provenance.bounds_basis = InWords(*corrected, clusters);
    return bounded;
  }
  Unstack(*fit, fit->theta, answers);
  bounded.bounds = StudentBounds(fit->theta, ClusterCovariance(*fit),
                                 static_cast<double>(clusters - 1), options.interval_level);
  Unbound(separable, answers, bounded.bounds);
  bounded.provenance.bounds_basis =
      "clusters of residuals (" + std::to_string(clusters) + "), Student t; not corrected for bias";
  return bounded;
}

}  // namespace telltale
