#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/linear_algebra/gram.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr double kPriorEffectSize = kDiagnosis.baseline.prior_effect_size;
constexpr double kPriorRecordings = kDiagnosis.baseline.prior_recordings;
constexpr double kInitialFixedEffectSd = kDiagnosis.baseline.initial_fixed_effect_sd;
constexpr double kCoefficientPriorScale = kDiagnosis.baseline.coefficient_prior_scale;
constexpr double kNegligibleSd = 1e-6;
constexpr double kMaximumOptimism = kDiagnosis.baseline.maximum_optimism;
constexpr int kMaximumRecalibrations = kDiagnosis.baseline.maximum_recalibrations;
constexpr double kConvergedRatio = kDiagnosis.baseline.converged_ratio;
constexpr double kSlopeStep = kDiagnosis.baseline.slope_step;
constexpr int kRounds = kDiagnosis.baseline.covariance_rounds;
constexpr int kIterations = kDiagnosis.baseline.variance_iterations;
constexpr std::array kStepLengths = kDiagnosis.baseline.step_lengths;

Eigen::MatrixXd SecondMoment(const std::vector<Eigen::MatrixXd>& residuals) {
  const Eigen::Index rows = residuals.front().rows();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows, rows);
  double windows = 0.0;
  for (const Eigen::MatrixXd& residual : residuals) {
    sum += residual * residual.transpose();
    windows += static_cast<double>(residual.cols());
  }
  sum /= windows;
  const double shrink =
      std::clamp(kDiagnosis.baseline.covariance_shrinkage * static_cast<double>(rows) / windows,
                 kDiagnosis.baseline.minimum_covariance_shrinkage,
                 kDiagnosis.baseline.maximum_covariance_shrinkage);
  const Eigen::VectorXd diagonal = sum.diagonal();
  sum *= 1.0 - shrink;
  sum.diagonal() += shrink * diagonal;
  return sum;
}

/// (1 - rho) / (1 + rho) of whitened errors from one window to the next.
double Kappa(const Eigen::LLT<Eigen::MatrixXd>& factor,
             const std::vector<Eigen::MatrixXd>& recordings) {
  double product = 0.0;
  double square = 0.0;
  for (const Eigen::MatrixXd& errors : recordings) {
    const Eigen::MatrixXd white = factor.matrixL().solve(errors);
    for (Eigen::Index w = 0; w + 1 < white.cols(); ++w) {
      product += white.col(w).dot(white.col(w + 1));
      square += 0.5 * (white.col(w).squaredNorm() + white.col(w + 1).squaredNorm());
    }
  }
  const double rho = square > 0.0 ? product / square : 0.0;
  return std::clamp((1.0 - rho) / (1.0 + rho), kDiagnosis.baseline.minimum_kappa, 1.0);
}

/// The mixed-effects fit to the nominal recordings. Unknowns, stacked: coefficients, fixed effects,
/// then the per-recording random effects of each day. The first two are changes of the boat about
/// which the sensitivities are; the random effects are estimated anew at each step.
class NominalBaselineFit {
 public:
  NominalBaselineFit(const UncertainModel& model,
                     const std::vector<EffectParameterRef>& parameter_refs, std::size_t days)
      : coefficient_count_(static_cast<Eigen::Index>(model.free.size())),
        parameter_count_(static_cast<Eigen::Index>(parameter_refs.size())),
        random_(RandomColumnsOf(parameter_refs)),
        days_(static_cast<Eigen::Index>(days)),
        coefficients_(Eigen::VectorXd::Zero(coefficient_count_)),
        fixed_(Eigen::VectorXd::Zero(parameter_count_)),
        fixed_effect_sd_(Eigen::VectorXd::Constant(parameter_count_, kInitialFixedEffectSd)),
        recording_effect_sd_(Eigen::VectorXd::Constant(RandomCount(), kPriorEffectSize)) {
    Eigen::MatrixXd correlation = model.Correlation();
    correlation.diagonal().array() += 1e-6;
    base_information_ = Inverse(correlation) / (kCoefficientPriorScale * kCoefficientPriorScale);
    fixed_effect_limits_.resize(parameter_count_, 2);
    for (Eigen::Index j = 0; j < parameter_count_; ++j) {
      const EffectParameterRef& parameter_ref = parameter_refs[static_cast<std::size_t>(j)];
      const EffectParameter& parameter =
          parameter_ref.effect->Parameters()[parameter_ref.parameter];
      fixed_effect_limits_.row(j) << parameter.lower / parameter.typical,
          parameter.upper / parameter.typical;
      if (parameter_ref.effect->Facts().nominal_variation == NominalVariation::kFixedEffect)
        continue;
      fixed_effect_limits_.row(j).setZero();
      fixed_effect_sd_[j] = kNegligibleSd;
    }
  }

  /// Sums up what whitened recordings say.
  void Accumulate(const std::vector<Sensitivity>& recordings,
                  const Eigen::LLT<Eigen::MatrixXd>& factor, double kappa) {
    gram_ = Eigen::MatrixXd::Zero(Size(), Size());
    right_ = Eigen::VectorXd::Zero(Size());
    const Eigen::Index shared = coefficient_count_ + parameter_count_;
    for (Eigen::Index day = 0; day < days_; ++day) {
      const Sensitivity& recording = recordings[static_cast<std::size_t>(day)];
      Eigen::MatrixXd phi(recording.errors.size(), shared + RandomCount() + 1);
      phi << recording.by_coefficient, recording.by_effect_parameter,
          recording.by_effect_parameter(Eigen::all, random_), recording.errors.reshaped();
      const Eigen::MatrixXd white = Whitened(factor, phi);
      const Eigen::MatrixXd gram = kappa * Gram(white);
      const Eigen::Index own = shared + day * RandomCount();
      const auto last = gram.col(shared + RandomCount());
      gram_.topLeftCorner(shared, shared) += gram.topLeftCorner(shared, shared);
      gram_.block(0, own, shared, RandomCount()) = gram.block(0, shared, shared, RandomCount());
      gram_.block(own, 0, RandomCount(), shared) = gram.block(shared, 0, RandomCount(), shared);
      gram_.block(own, own, RandomCount(), RandomCount()) =
          gram.block(shared, shared, RandomCount(), RandomCount());
      right_.head(shared) -= last.head(shared);
      right_.segment(own, RandomCount()) = -last.segment(shared, RandomCount());
    }
  }

  /// In turn unknowns given sizes, sizes given unknowns.
  void Solve() {
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      unknowns_ = Step();
      UpdateStandardDeviations();
    }
  }

  /// Changes of the boat that are made already.
  void StartFrom(const NominalBaseline& baseline) {
    coefficients_ = baseline.coefficients;
    fixed_ = baseline.fixed_effects;
  }

  /// Makes the change that was found; the next one is sought from there.
  void Accept(double share) {
    coefficients_ += share * unknowns_.head(coefficient_count_);
    fixed_ = (fixed_ + share * unknowns_.segment(coefficient_count_, parameter_count_))
                 .cwiseMax(fixed_effect_limits_.col(0))
                 .cwiseMin(fixed_effect_limits_.col(1));
  }

  /// What the weather of a day does to a recording's errors, to be taken away by adding this.
  Eigen::MatrixXd RecordingEffects(const Sensitivity& recording, std::size_t day) const {
    const Eigen::VectorXd sizes = unknowns_.segment(
        coefficient_count_ + parameter_count_ + static_cast<Eigen::Index>(day) * RandomCount(),
        RandomCount());
    return (recording.by_effect_parameter(Eigen::all, random_) * sizes)
        .reshaped(recording.errors.rows(), recording.errors.cols());
  }

  /// A recording's errors after the step, if they were linear.
  Eigen::MatrixXd PredictedResiduals(const Sensitivity& recording, std::size_t day) const {
    const Eigen::VectorXd left =
        recording.errors.reshaped() +
        recording.by_coefficient * unknowns_.head(coefficient_count_) +
        recording.by_effect_parameter * unknowns_.segment(coefficient_count_, parameter_count_);
    return left.reshaped(recording.errors.rows(), recording.errors.cols()) +
           RecordingEffects(recording, day);
  }

  const Eigen::VectorXd& Coefficients() const { return coefficients_; }
  const Eigen::VectorXd& FixedEffects() const { return fixed_; }
  Eigen::VectorXd RecordingEffectSd() const {
    Eigen::VectorXd sizes = Eigen::VectorXd::Zero(parameter_count_);
    sizes(random_) = recording_effect_sd_;
    return sizes;
  }
  Eigen::MatrixXd BoatCovariance() const {
    return Inverse(Information())
        .topLeftCorner(coefficient_count_ + parameter_count_,
                       coefficient_count_ + parameter_count_);
  }

 private:
  static std::vector<Eigen::Index> RandomColumnsOf(
      const std::vector<EffectParameterRef>& parameter_refs) {
    std::vector<Eigen::Index> random_columns;
    for (std::size_t j = 0; j < parameter_refs.size(); ++j) {
      if (parameter_refs[j].effect->Facts().nominal_variation ==
          NominalVariation::kRecordingEffect) {
        random_columns.push_back(static_cast<Eigen::Index>(j));
      }
    }
    return random_columns;
  }

  Eigen::Index RandomCount() const { return static_cast<Eigen::Index>(random_.size()); }
  Eigen::Index Size() const {
    return coefficient_count_ + parameter_count_ + days_ * RandomCount();
  }

  Eigen::MatrixXd Information() const {
    Eigen::MatrixXd information = gram_;
    information.topLeftCorner(coefficient_count_, coefficient_count_) += base_information_;
    information.diagonal().segment(coefficient_count_, parameter_count_) +=
        fixed_effect_sd_.cwiseAbs2().cwiseInverse();
    information.diagonal().tail(days_ * RandomCount()) +=
        recording_effect_sd_.cwiseAbs2().cwiseInverse().replicate(days_, 1);
    return information;
  }

  Eigen::VectorXd Step() const {
    Eigen::VectorXd right = right_;
    right.head(coefficient_count_) -= base_information_ * coefficients_;
    right.segment(coefficient_count_, parameter_count_) -=
        fixed_.cwiseQuotient(fixed_effect_sd_.cwiseAbs2());
    return Information().llt().solve(right);
  }

  // By the most probable unknowns, not by expectation: what weather shares with the coefficients,
  // which are the same every day, would otherwise keep it large for ever.
  void UpdateStandardDeviations() {
    const double prior = kPriorRecordings * kPriorEffectSize * kPriorEffectSize;
    const auto recording_effects =
        unknowns_.tail(days_ * RandomCount()).reshaped(RandomCount(), days_);
    recording_effect_sd_ = ((recording_effects.rowwise().squaredNorm().array() + prior) /
                            (static_cast<double>(days_) + kPriorRecordings))
                               .sqrt();
    for (Eigen::Index j = 0; j < parameter_count_; ++j) {
      if (fixed_effect_limits_(j, 0) == fixed_effect_limits_(j, 1)) continue;
      const double now = fixed_[j] + unknowns_[coefficient_count_ + j];
      fixed_effect_sd_[j] = std::sqrt((prior + now * now) / (1.0 + kPriorRecordings));
    }
  }

  Eigen::Index coefficient_count_;
  Eigen::Index parameter_count_;
  std::vector<Eigen::Index> random_;  // columns of per-recording effects
  Eigen::Index days_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd fixed_;
  Eigen::VectorXd fixed_effect_sd_;
  Eigen::VectorXd recording_effect_sd_;
  Eigen::MatrixXd base_information_;
  Eigen::MatrixXd fixed_effect_limits_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  Eigen::VectorXd unknowns_;
};

/// By how much more a recording that took no part in estimating the covariance leaves by it: the
/// mean of Hotelling's T^2 over its rows, n / (n - rows - 1) with n windows.
double OptimismOf(const std::vector<Sensitivity>& days) {
  const auto rows = static_cast<double>(days.front().errors.rows());
  double windows = 0.0;
  for (const Sensitivity& day : days) windows += static_cast<double>(day.errors.cols());
  return windows / std::max(windows - rows - 1.0, windows / kMaximumOptimism);
}

using Recordings = std::vector<const FreeRuns*>;

std::vector<Sensitivity> SensitivitiesOf(const Recordings& recordings, const ChangedBoat& boat,
                                         const UncertainModel& model,
                                         const std::vector<EffectParameterRef>& parameter_refs,
                                         std::size_t threads, double step) {
  std::vector<Sensitivity> sensitivities;
  for (const FreeRuns* runs : recordings) {
    sensitivities.push_back(SensitivityOf(*runs, boat, model, parameter_refs, threads, step));
  }
  return sensitivities;
}

/// Gauss-Newton estimation of the nominal boat.
class BaselineEstimation {
 public:
  /// From the model on.
  BaselineEstimation(Recordings recordings, Recordings others, const UncertainModel& model,
                     const std::vector<EffectParameterRef>& parameter_refs, std::size_t threads)
      : recordings_(std::move(recordings)),
        others_(std::move(others)),
        model_(model),
        parameter_refs_(parameter_refs),
        threads_(threads),
        fit_(model, parameter_refs, recordings_.size()),
        boat_{model.model, {}} {
    Outcome outcome = OutcomeOf(boat_);
    divergence_of_model_ = outcome.divergence;
    errors_ = std::move(outcome.errors);
    residuals_ = errors_;
    covariance_ = SecondMoment(residuals_);
  }

  /// From the baseline of more recordings on, with its slopes of these.
  BaselineEstimation(Recordings recordings, Recordings others, const UncertainModel& model,
                     const std::vector<EffectParameterRef>& parameter_refs,
                     const NominalBaseline& baseline, std::vector<Sensitivity> slopes)
      : recordings_(std::move(recordings)),
        others_(std::move(others)),
        model_(model),
        parameter_refs_(parameter_refs),
        threads_(1),
        fit_(model, parameter_refs, recordings_.size()),
        divergence_of_model_(baseline.divergence_of_model),
        boat_(baseline.boat),
        sensitivities_(std::move(slopes)),
        covariance_(baseline.covariance) {
    fit_.StartFrom(baseline);
    for (const Sensitivity& day : sensitivities_) errors_.push_back(day.errors);
    residuals_ = errors_;
  }

  /// A step with new slopes. Whether the boat changed for the better by enough to go on.
  bool Improve() {
    sensitivities_ = SensitivitiesOf(recordings_, {boat_, fit_.Coefficients()}, model_,
                                     parameter_refs_, threads_, kSlopeStep);
    return Step() < kConvergedRatio;
  }

  /// A step with the slopes there are; the square after it over that before.
  double Step() {
    // Whitened by the scatter that the slopes predict to be left. The present scatter would count
    // what the boat still does wrong as noise.
    for (int round = 0; round < kRounds; ++round) {
      Reestimate();
      for (std::size_t day = 0; day < residuals_.size(); ++day) {
        residuals_[day] = fit_.PredictedResiduals(sensitivities_[day], day);
      }
      covariance_ = SecondMoment(residuals_);
    }
    factor_.compute(covariance_);
    residuals_ = LessRecordingEffects(errors_);
    const double before = SquaredNorm(residuals_);
    return LineSearch(before) / before;
  }

  /// With new slopes over the whole typical size.
  NominalBaseline Baseline() {
    return Baseline(SensitivitiesOf(recordings_, {boat_, fit_.Coefficients()}, model_,
                                    parameter_refs_, threads_, 1.0));
  }

  /// With the slopes there are.
  NominalBaseline BaselineWithOldSlopes() {
    std::vector<Sensitivity> days = sensitivities_;
    for (std::size_t day = 0; day < days.size(); ++day) days[day].errors = errors_[day];
    return Baseline(std::move(days));
  }

 private:
  NominalBaseline Baseline(std::vector<Sensitivity> days) {
    covariance_ = SecondMoment(residuals_);
    Reestimate();
    NominalBaseline nominal{.boat = boat_,
                            .coefficients = fit_.Coefficients(),
                            .fixed_effects = fit_.FixedEffects(),
                            .covariance = covariance_,
                            .kappa = kappa_,
                            .boat_covariance = fit_.BoatCovariance(),
                            .recording_effect_sd = fit_.RecordingEffectSd(),
                            .days = std::move(days),
                            .divergence_of_model = divergence_of_model_,
                            .log_reduced_chi_squares = {}};
    const double optimism = std::log(OptimismOf(nominal.days));
    for (const Sensitivity& day : nominal.days) {
      const ResidualMetric metric(nominal, day, EveryWindow(day), false);
      nominal.log_reduced_chi_squares.push_back(
          std::log(metric.ReducedChiSquare(metric.Whiten(day.errors))) + optimism);
    }
    return nominal;
  }

  void Reestimate() {
    factor_.compute(covariance_);
    kappa_ = Kappa(factor_, residuals_);
    fit_.Accumulate(sensitivities_, factor_, kappa_);
    fit_.Solve();
  }

  // Steps are longer than linear: a delay or a dead zone that is found moves much besides.
  double LineSearch(double before) {
    const NominalBaselineFit start = fit_;
    double least = before;
    for (const double share : kStepLengths) {
      NominalBaselineFit tried = start;
      tried.Accept(share);
      const Eigen::VectorXd change = tried.Coefficients().cwiseProduct(model_.StandardErrors());
      AugmentedModel boat{model_.Changed(change), EffectsOf(parameter_refs_, tried.FixedEffects())};
      auto [errors, divergence] = OutcomeOf(boat);
      if (divergence.IsWorseThan(divergence_of_model_)) continue;
      auto left = LessRecordingEffects(errors);
      const double square = SquaredNorm(left);
      if (square >= least) {
        if (least < before) break;
        continue;
      }
      least = square;
      fit_ = std::move(tried);
      boat_ = std::move(boat);
      errors_ = std::move(errors);
      residuals_ = std::move(left);
    }
    return least;
  }

  /// The errors of each recording, and the divergence of these and of the others.
  struct Outcome {
    std::vector<Eigen::MatrixXd> errors;
    Divergence divergence;
  };

  Outcome OutcomeOf(const AugmentedModel& boat) const {
    Outcome outcome;
    outcome.errors.resize(recordings_.size());
    std::vector<Divergence> each(recordings_.size() + others_.size());
    ForEachIndex(each.size(), threads_, [&](std::size_t i) {
      if (i >= recordings_.size()) {
        each[i] = others_[i - recordings_.size()]->DivergenceOf(boat);
        return;
      }
      FreeRuns::Outcome own = recordings_[i]->OutcomeOf(boat);
      outcome.errors[i] = std::move(own.errors);
      each[i] = own.divergence;
    });
    for (const Divergence& one : each) outcome.divergence.Add(one);
    return outcome;
  }

  std::vector<Eigen::MatrixXd> LessRecordingEffects(std::vector<Eigen::MatrixXd> left) const {
    for (std::size_t day = 0; day < left.size(); ++day) {
      left[day] += fit_.RecordingEffects(sensitivities_[day], day);
    }
    return left;
  }

  double SquaredNorm(const std::vector<Eigen::MatrixXd>& errors) const {
    double sum = 0.0;
    for (const Eigen::MatrixXd& day : errors) sum += factor_.matrixL().solve(day).squaredNorm();
    return sum;
  }

  Recordings recordings_;
  Recordings others_;
  const UncertainModel& model_;
  const std::vector<EffectParameterRef>& parameter_refs_;
  std::size_t threads_;
  NominalBaselineFit fit_;
  Divergence divergence_of_model_;
  AugmentedModel boat_;
  std::vector<Sensitivity> sensitivities_;
  std::vector<Eigen::MatrixXd> errors_;     ///< of the boat
  std::vector<Eigen::MatrixXd> residuals_;  ///< the same less what weather did
  Eigen::MatrixXd covariance_;
  Eigen::LLT<Eigen::MatrixXd> factor_;  ///< of it
  double kappa_ = 1.0;
};

}  // namespace

NominalBaseline LearnNominalBaseline(const std::vector<FreeRuns>& recordings,
                                     const UncertainModel& model,
                                     const std::vector<EffectParameterRef>& parameter_refs,
                                     std::size_t threads, std::vector<const FreeRuns*> others) {
  Require(!recordings.empty(), "at least one nominal recording");
  Recordings all;
  for (const FreeRuns& runs : recordings) all.push_back(&runs);
  BaselineEstimation estimation(std::move(all), std::move(others), model, parameter_refs, threads);
  for (int round = 0; round < kMaximumRecalibrations && estimation.Improve(); ++round) continue;
  return estimation.Baseline();
}

NominalBaseline NominalBaselineOf(const std::vector<std::size_t>& kept,
                                  const NominalBaseline& of_all,
                                  const std::vector<FreeRuns>& recordings,
                                  const UncertainModel& model,
                                  const std::vector<EffectParameterRef>& parameter_refs,
                                  std::vector<const FreeRuns*> others) {
  Require(!kept.empty(), "at least one nominal recording");
  Recordings kept_recordings;
  std::vector<Sensitivity> slopes;
  for (const std::size_t day : kept) {
    kept_recordings.push_back(&recordings[day]);
    slopes.push_back(of_all.days[day]);
  }
  BaselineEstimation estimation(std::move(kept_recordings), std::move(others), model,
                                parameter_refs, of_all, std::move(slopes));
  estimation.Step();
  return estimation.BaselineWithOldSlopes();
}

}  // namespace telltale
