#include "telltale/core/identification/weak_iv_answer.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/separable_columns.hpp"
#include "telltale/core/estimation/weak_iv.hpp"
#include "telltale/core/identification/weak_iv_publication.hpp"
#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/uncertainty/twin_correction.hpp"

namespace telltale {
namespace {

constexpr double kLongestPartS = 60.0;

Refusal HeadingHardlyVaries(std::size_t recordings) {
  return {"steady disturbance",
          "in " + std::to_string(recordings) +
              " of the recordings the heading hardly varies: a part that stands to the north and "
              "east cannot be told from one that turns with the boat, and is left out there",
          "record courses in all directions"};
}

/// The columns that are sought, steady terms of each recording among them.
std::array<std::vector<std::size_t>, 3> WithOffsets(
    const PreparedDataset& dataset, const RegressionOptions& regression,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakFormOptions& form,
    std::vector<Refusal>& refusals) {
  if (regression.offsets == Offsets::kShared) return columns;
  const std::vector<bool> varies = HeadingVaries(dataset);
  const auto steady = std::count(varies.begin(), varies.end(), false);
  if (regression.offsets == Offsets::kPerRecordingNorthEast && steady > 0) {
    refusals.push_back(HeadingHardlyVaries(static_cast<std::size_t>(steady)));
  }
  return WithSteadyTerms(dataset, BuildWeakForm(dataset, regression, form), columns, varies);
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

/// Splits the published unknowns into the answers they are.
void Unstack(const WeakFit& fit, const WeakIvPublication& publication, const Eigen::VectorXd& theta,
             Answers& answers) {
  Eigen::Index next = 0;
  if (fit.time_constant_s) {
    answers.lag = AnsweredLag{std::max(theta[next++], 0.0), LagIsAtItsLeast(fit)};
  }
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const std::vector<std::size_t>& columns = publication.columns[j];
    const auto size = static_cast<Eigen::Index>(columns.size());
    Place(kEquations[j], columns, theta.segment(next, size), next, answers);
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

/// A mean of several unknowns has an interval as long as the one that takes the longest.
Eigen::VectorXd PublishedFactors(const WeakIvPublication& publication,
                                 const Eigen::VectorXd& interval_factors) {
  Eigen::VectorXd factors(publication.map.rows());
  for (Eigen::Index i = 0; i < factors.size(); ++i) {
    const auto takes_part = publication.map.row(i).array() != 0.0;
    factors[i] = takes_part.select(interval_factors.transpose().array(), 0.0).maxCoeff();
  }
  return factors;
}

std::string InWords(const TwinCorrection& corrected, Eigen::Index clusters) {
  std::ostringstream words;
  words.precision(3);
  words << "clusters of residuals (" << clusters << "), bias taken out and bounds sized by "
        << corrected.solved << " simulated repeats of this data set, Student t";
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

WeakLook LookWeakly(const PreparedDataset& dataset, const RegressionOptions& regression,
                    const IdentifyOptions& options) {
  WeakLook look{AssessAll(dataset, regression, options.excitation), {}, std::nullopt};
  look.columns = Sought(look.answers);
  if (look.answers.Any()) {
    look.fit = EstimateWeakIv(dataset, regression, look.columns, options.weak_iv);
  }
  return look;
}

Result<BoundedAnswers> BoundWeakIv(const PreparedDataset& dataset,
                                   const RegressionOptions& regression,
                                   const IdentifyOptions& options, const Progress& progress,
                                   const std::optional<WeakLook>& look) {
  BoundedAnswers bounded;
  bounded.estimator = Estimator::kWeakIv;
  Answers& answers = bounded.answers;
  answers = look ? look->answers : AssessAll(dataset, regression, options.excitation);
  if (!answers.Any()) return tl::unexpected(NothingAnswered(answers.refusals));
  const SeparableColumns separable =
      Separate(dataset, regression, Sought(answers), options.weak_iv.form);
  TellGroups(separable, regression.parameterization, answers);
  const auto columns =
      WithOffsets(dataset, regression, separable.kept, options.weak_iv.form, answers.refusals);
  const auto fit = look && look->columns == columns
                       ? look->fit
                       : EstimateWeakIv(dataset, regression, columns, options.weak_iv);
  if (!fit || fit->scores.cols() < 2 || !ClusterCovariance(*fit).allFinite()) {
    return tl::unexpected(InstrumentsSayNothing());
  }
  CountWindows(*fit, answers);
  const Eigen::Index clusters = fit->scores.cols();
  bounded.provenance.clusters = static_cast<std::size_t>(clusters);
  if (auto warning = WarnOfFewClusters(clusters)) answers.refusals.push_back(*std::move(warning));

  std::optional<TwinCorrection> corrected;
  if (options.twins > 0) {
    corrected =
        CorrectWithTwins(dataset, regression, *fit, columns, options.weak_iv,
                         {options.twins, options.seed, options.threads}, [&](double fraction) {
                           if (progress) progress("simulating repeats", 0.4 + 0.55 * fraction);
                         });
    if (!corrected) answers.refusals.push_back(NotCorrected());
  }
  const WeakIvPublication publication = PublicationOf(*fit);
  const auto publish = [&](const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                           const Eigen::VectorXd& interval_factors, double degrees_of_freedom) {
    const Eigen::VectorXd published = publication.map * theta;
    Unstack(*fit, publication, published, answers);
    bounded.bounds = StudentBounds(published, Mapped(publication.map, covariance),
                                   PublishedFactors(publication, interval_factors),
                                   degrees_of_freedom, options.interval_level);
    Unbound(separable, answers, bounded.bounds);
    bounded.offsets = OffsetsOf(publication, published, bounded.bounds, dataset);
  };
  if (corrected) {
    publish(corrected->theta, corrected->covariance, corrected->interval_factors,
            corrected->degrees_of_freedom);
    bounded.bounds.joint = corrected->joint;
    bounded.disturbance = corrected->disturbance;
    bounded.provenance.twins = corrected->solved;
    bounded.provenance.twin_failures = corrected->failures;
    bounded.provenance.bounds_basis = InWords(*corrected, clusters);
    return bounded;
  }
  publish(fit->theta, ClusterCovariance(*fit), Eigen::VectorXd::Ones(fit->theta.size()),
          static_cast<double>(clusters - 1));
  bounded.provenance.bounds_basis =
      "clusters of residuals (" + std::to_string(clusters) + "), Student t; not corrected for bias";
  return bounded;
}

}  // namespace telltale
