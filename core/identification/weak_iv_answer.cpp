#include "identification/weak_iv_answer.hpp"

#include <algorithm>
#include <sstream>

#include "data/preparation.hpp"
#include "estimation/weak_iv.hpp"
#include "uncertainty/twin_correction.hpp"

namespace telltale {
namespace {

constexpr double kLongestPartS = 60.0;

/// Splits the stacked unknowns into the answers they are.
void Unstack(const WeakFit& fit, const Eigen::VectorXd& theta, Answers& answers) {
  Eigen::Index next = 0;
  if (fit.time_constant_s) {
    answers.lag = AnsweredLag{std::max(theta[next++], 0.0), LagIsAtItsLeast(fit)};
  }
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const std::vector<std::size_t>& columns = fit.equations[j]->columns;
    const auto size = static_cast<Eigen::Index>(columns.size());
    Place(kEquations[j], columns, theta.segment(next, size), next, answers);
    next += size;
  }
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
  bounded.estimator = Estimator::kWeakIv;
  Answers& answers = bounded.answers;
  answers = AssessAll(dataset, regression, options.excitation);
  if (!answers.Any()) return tl::unexpected(NothingAnswered(answers.refusals));
  const auto columns = Sought(answers);
  const auto fit = EstimateWeakIv(dataset, regression, columns, options.weak_iv);
  if (!fit || fit->scores.cols() < 2 || !ClusterCovariance(*fit).allFinite()) {
    return tl::unexpected(InstrumentsSayNothing());
  }
  const Eigen::Index clusters = fit->scores.cols();
  if (auto warning = WarnOfFewClusters(clusters)) answers.refusals.push_back(*std::move(warning));

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
    bounded.disturbance = corrected->disturbance;
    bounded.provenance.twins = corrected->solved;
    bounded.provenance.twin_failures = corrected->failures;
    bounded.provenance.bounds_basis = InWords(*corrected, clusters);
    return bounded;
  }
  Unstack(*fit, fit->theta, answers);
  bounded.bounds = StudentBounds(fit->theta, ClusterCovariance(*fit),
                                 static_cast<double>(clusters - 1), options.interval_level);
  bounded.provenance.bounds_basis =
      "clusters of residuals (" + std::to_string(clusters) + "), Student t; not corrected for bias";
  return bounded;
}

}  // namespace telltale
