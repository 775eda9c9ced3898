#include "telltale/core/identification/coverage_check.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/estimation/weak_form/separable_columns.hpp"
#include "telltale/core/identification/shrinkage.hpp"
#include "telltale/core/identification/weak_iv_estimate.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"
#include "telltale/core/uncertainty/bootstrap_correction.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr const char* kSubject = "coverage_check";
constexpr const char* kAdvice = "record for longer, with more varied manoeuvres";

/// Simulation and identification of a replicate draw from streams of their own.
enum class Draw : std::uint64_t { kSimulation, kIdentification };

std::uint64_t SeedOf(std::uint64_t seed, std::size_t replicate, Draw draw) {
  return RandomEngine::Stream(seed, 2 * replicate + static_cast<std::uint64_t>(draw))();
}

/// The data prepared for simulation: in parts of a minute, whose replicates stay near the record.
Result<PreparedDataset> PrepareForSimulation(const Recording& recording, const Vehicle& vehicle,
                                             const Identification& identification,
                                             const IdentifyOptions& options) {
  PrepareOptions prepare = options.prepare;
  prepare.preset = Preset::kRobust;
  prepare.sampling_period_s = identification.sampling_period_s;
  return PrepareForWeakIv(recording, vehicle, prepare);
}

/// A weak-form fit of the same data, whatever estimator is checked. It gives the disturbance where
/// that estimator does not, and a regularised model.
struct WeakFormFit {
  RegressionOptions regression;
  std::array<std::vector<std::size_t>, 3> columns;
  std::optional<WeakFit> fit;
};

WeakFormFit FitWeakForm(const PreparedDataset& dataset, const Identification& identification,
                        const IdentifyOptions& options) {
  WeakFormFit weak_form{options.regression, {}, std::nullopt};
  weak_form.regression.dead_zone = identification.dead_zone;
  std::array<std::size_t, 3> next{};
  for (const Coefficient& c : identification.coefficients) {
    const std::size_t j = IndexOf(c.equation);
    if (c.status != CoefficientStatus::kNotExcited) weak_form.columns[j].push_back(next[j]);
    ++next[j];
  }
  weak_form.columns =
      Separate(dataset, weak_form.regression, weak_form.columns, options.weak_iv.form).kept;
  weak_form.fit = EstimateWeakIv(dataset, weak_form.regression, weak_form.columns, options.weak_iv);
  if (weak_form.fit && weak_form.fit->scores.cols() < 2) weak_form.fit.reset();
  return weak_form;
}

/// Models to take for the truth: the reported one, then the simulation parameters, then models
/// between the reported and the regularised one.
std::vector<VesselModel> Candidates(const Identification& identification,
                                    const WeakFormFit& weak_form) {
  const VesselModel reported = RegularisedModel(identification, kUnregularised);
  std::vector<VesselModel> candidates = {reported};
  if (!identification.simulation.empty()) candidates.push_back(*ModelOf(identification));
  if (!weak_form.fit) return candidates;
  const VesselModel regularised =
      ModelOf(*weak_form.fit, weak_form.fit->Regularised(), identification.sampling_period_s);
  for (const double share : {0.5, 0.25, 0.0}) {
    VesselModel between = reported;
    for (std::size_t j = 0; j < between.theta.size(); ++j) {
      between.theta[j] = share * reported.theta[j] + (1.0 - share) * regularised.theta[j];
    }
    candidates.push_back(between);
  }
  return candidates;
}

/// The model that stands for the truth.
struct Truth {
  VesselModel model;
  bool as_reported = false;

  double Of(const Identification& identification, std::size_t coefficient) const {
    const Equation equation = identification.coefficients[coefficient].equation;
    std::size_t first = coefficient;
    while (first > 0 && identification.coefficients[first - 1].equation == equation) --first;
    return model.theta[IndexOf(equation)][static_cast<Eigen::Index>(coefficient - first)];
  }
};

/// How often one coefficient's bounds hold, replicate by replicate.
class CoverageCount {
 public:
  /// Whether the bounds hold the truth; nothing when there are none.
  std::optional<bool> Add(const Coefficient& coefficient, double truth) {
    if (!std::isfinite(coefficient.standard_error) || coefficient.standard_error <= 0.0) {
      return std::nullopt;
    }
    const bool held = truth >= coefficient.interval.lower && truth <= coefficient.interval.upper;
    tally_.Add(held);
    off_ += (coefficient.estimate - truth) / coefficient.standard_error;
    return held;
  }

  CoefficientCoverage Coverage() const {
    return {tally_, tally_.of == 0 ? 0.0 : off_ / static_cast<double>(tally_.of)};
  }

 private:
  Tally tally_;
  double off_ = 0.0;
};

class CoverageExperiment {
 public:
  CoverageExperiment(const PreparedDataset& dataset, const Identification& identification,
                     const IdentifyOptions& options, const Progress& progress)
      : dataset_(dataset),
        identification_(identification),
        options_(options),
        progress_(progress),
        fractions_(options.coverage_check_replicates, 0.0) {}

  Result<CoverageCheck> Run(const Disturbance& disturbance,
                            const std::vector<VesselModel>& candidates) {
    disturbance_ = disturbance;
    const auto truth = FindTruth(candidates);
    if (!truth) {
      return Refuse(kSubject, "the identified model diverges under the recorded commands", kAdvice);
    }
    std::vector<std::optional<Identification>> replicates(options_.coverage_check_replicates);
    ForEachIndex(replicates.size(), options_.threads, [&](std::size_t i) {
      replicates[i] = IdentifyReplicate(*truth, i);
      Report(i, 1.0);
    });
    std::erase(replicates, std::nullopt);
    if (replicates.empty()) {
      return Refuse(kSubject, "not one parametric bootstrap replicate could be identified",
                    kAdvice);
    }
    return Count(*truth, replicates);
  }

 private:
  SyntheticDatasetOptions SimulationOptionsOf(std::size_t replicate) const {
    SyntheticDatasetOptions simulation_options;
    simulation_options.disturbance = disturbance_;
    simulation_options.seed = SeedOf(options_.seed, replicate, Draw::kSimulation);
    for (const Equation equation : kEquations) {
      simulation_options.as_measured[IndexOf(equation)] = !identification_.Has(equation);
    }
    return simulation_options;
  }

  /// The first that can be simulated; the first of all is the reported model.
  std::optional<Truth> FindTruth(const std::vector<VesselModel>& candidates) const {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (CanBeSimulated(candidates[i])) return Truth{candidates[i], i == 0};
    }
    return std::nullopt;
  }

  /// In at least half of a few trials, because the disturbance alone may make a run diverge.
  bool CanBeSimulated(const VesselModel& model) const {
    constexpr std::size_t kTrials = 8;
    std::size_t simulated = 0;
    for (std::size_t i = 0; i < kTrials; ++i) {
      if (SimulateRecording(dataset_, model, SimulationOptionsOf(i))) ++simulated;
    }
    return 2 * simulated >= kTrials;
  }

  std::optional<Identification> IdentifyReplicate(const Truth& truth, std::size_t replicate) {
    const auto synthetic = SimulateRecording(dataset_, truth.model, SimulationOptionsOf(replicate));
    if (!synthetic) return std::nullopt;
    IdentifyOptions options = options_;
    options.prepare.sampling_period_s = dataset_.sampling_period_s;
    options.coverage_check_replicates = 0;
    options.advise = false;
    options.threads = 1;
    options.seed = SeedOf(options_.seed, replicate, Draw::kIdentification);
    auto again = Identify(synthetic->recording, synthetic->vehicle, options,
                          [&](std::string_view, double fraction) { Report(replicate, fraction); });
    if (!again) return std::nullopt;
    return *std::move(again);
  }

  void Report(std::size_t replicate, double fraction) {
    if (!progress_) return;
    const std::lock_guard lock(reporting_);
    reported_ += std::max(0.0, fraction - fractions_[replicate]);
    fractions_[replicate] = std::max(fraction, fractions_[replicate]);
    progress_("checking coverage on simulated replicates",
              std::min(1.0, reported_ / static_cast<double>(fractions_.size())));
  }

  CoverageCheck Count(const Truth& truth,
                      const std::vector<std::optional<Identification>>& replicates) const {
    CoverageCheck coverage_check;
    coverage_check.replicates_requested = options_.coverage_check_replicates;
    coverage_check.replicates_identified = replicates.size();
    coverage_check.seed = options_.seed;
    coverage_check.level = options_.interval_level;
    coverage_check.truth_is_reported_model = truth.as_reported;
    std::vector<CoverageCount> counts(identification_.coefficients.size());
    CoverageCount lag;
    std::vector<Tally> by_replicate(replicates.size());
    for (std::size_t i = 0; i < replicates.size(); ++i) {
      const Identification& replicate = *replicates[i];
      for (std::size_t j = 0; j < counts.size(); ++j) {
        const Coefficient* again = Find(replicate, identification_.coefficients[j]);
        if (again == nullptr) continue;
        const auto held = counts[j].Add(*again, truth.Of(identification_, j));
        if (held) by_replicate[i].Add(*held);
      }
      if (replicate.thruster_time_constant && identification_.thruster_time_constant) {
        lag.Add(*replicate.thruster_time_constant,
                identification_.thruster_time_constant->estimate);
      }
      if (const auto held = EllipsoidHolds(truth, replicate)) coverage_check.joint.Add(*held);
    }
    for (const CoverageCount& count : counts)
      coverage_check.coefficients.push_back(count.Coverage());
    if (identification_.thruster_time_constant) {
      coverage_check.thruster_time_constant = lag.Coverage();
    }
    WriteMean(by_replicate, coverage_check);
    return coverage_check;
  }

  static const Coefficient* Find(const Identification& replicate, const Coefficient& wanted) {
    const auto found = std::find_if(
        replicate.coefficients.begin(), replicate.coefficients.end(), [&](const Coefficient& c) {
          return c.equation == wanted.equation && c.regressor == wanted.regressor;
        });
    return found == replicate.coefficients.end() ? nullptr : &*found;
  }

  /// Whether the replicate's ellipsoid at the level of its bounds holds the truth. Without a joint
  /// statement its covariance counts as known. Nothing when the replicate bounds fewer coefficients
  /// than the identification.
  std::optional<bool> EllipsoidHolds(const Truth& truth, const Identification& replicate) const {
    std::vector<Eigen::Index> places;
    std::vector<double> off;
    for (std::size_t j = 0; j < identification_.coefficients.size(); ++j) {
      if (!std::isfinite(identification_.coefficients[j].standard_error)) continue;
      const Coefficient* again = Find(replicate, identification_.coefficients[j]);
      if (again == nullptr || !std::isfinite(again->standard_error)) return std::nullopt;
      places.push_back(again - replicate.coefficients.data());
      off.push_back((again->estimate - truth.Of(identification_, j)) / again->standard_error);
    }
    if (places.empty()) return std::nullopt;
    const Eigen::MatrixXd covariance = replicate.covariance(places, places);
    const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd correlation = Scaled(covariance, scale);
    const Eigen::LLT<Eigen::MatrixXd> llt(correlation);
    if (llt.info() != Eigen::Success) return std::nullopt;
    const Eigen::VectorXd z =
        Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size()));
    const double squared_radius =
        replicate.joint
            ? SquaredRadius(*replicate.joint, off.size(), options_.interval_level)
            : ChiSquaredQuantile(static_cast<double>(off.size()), options_.interval_level);
    return z.dot(llt.solve(z)) <= squared_radius;
  }

  static void WriteMean(const std::vector<Tally>& by_replicate, CoverageCheck& coverage_check) {
    double sum = 0.0;
    double squares = 0.0;
    double n = 0.0;
    for (const Tally& tally : by_replicate) {
      if (tally.of == 0) continue;
      sum += tally.Share();
      squares += tally.Share() * tally.Share();
      n += 1.0;
    }
    if (n == 0.0) return;
    coverage_check.mean_coverage = sum / n;
    if (n < 2.0) return;
    const double variance = (squares - sum * sum / n) / (n - 1.0);
    coverage_check.mean_coverage_error = std::sqrt(std::max(0.0, variance) / n);
  }

  const PreparedDataset& dataset_;
  const Identification& identification_;
  const IdentifyOptions& options_;
  const Progress& progress_;
  Disturbance disturbance_;
  std::mutex reporting_;
  std::vector<double> fractions_;
  double reported_ = 0.0;
};

}  // namespace

Result<CoverageCheck> CheckCoverage(const Recording& recording, const Vehicle& vehicle,
                                    const Identification& identification,
                                    const IdentifyOptions& options, const Progress& progress) {
  const auto dataset = PrepareForSimulation(recording, vehicle, identification, options);
  if (!dataset) return tl::unexpected(dataset.error());
  const WeakFormFit weak_form = FitWeakForm(*dataset, identification, options);
  auto disturbance = identification.disturbance;
  if (!disturbance && weak_form.fit) {
    disturbance = DisturbanceFromResiduals(*dataset, weak_form.regression, *weak_form.fit,
                                           options.weak_iv, options.seed);
  }
  if (!disturbance) {
    return Refuse(kSubject, "the disturbance cannot be estimated from these data", kAdvice);
  }
  return CoverageExperiment(*dataset, identification, options, progress)
      .Run(*disturbance, Candidates(identification, weak_form));
}

}  // namespace telltale
