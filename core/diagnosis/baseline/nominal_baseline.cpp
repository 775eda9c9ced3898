#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/baseline/mixed_effects_fit.hpp"
#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr double kMaximumOptimism = kDiagnosis.baseline.maximum_optimism;
constexpr int kMaximumRecalibrations = kDiagnosis.baseline.maximum_recalibrations;
constexpr double kConvergedRatio = kDiagnosis.baseline.converged_ratio;
constexpr double kSlopeStep = kDiagnosis.baseline.slope_step;
constexpr int kRounds = kDiagnosis.baseline.covariance_rounds;
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

/// The generalised variance of errors, the determinant of their second moment, per row.
double GeneralisedVariance(const std::vector<Eigen::MatrixXd>& residuals) {
  const Eigen::LLT<Eigen::MatrixXd> factor(SecondMoment(residuals));
  return std::exp(LogDeterminant(factor) / static_cast<double>(factor.rows()));
}

/// By how much more a recording that took no part in estimating the covariance leaves by it: the
/// mean of Hotelling's T^2 over its rows, n / (n - rows - 1) with n windows.
double OptimismOf(const std::vector<Sensitivity>& days) {
  const auto rows = static_cast<double>(days.front().errors.rows());
  double windows = 0.0;
  for (const Sensitivity& day : days) windows += static_cast<double>(day.errors.cols());
  return windows / std::max(windows - rows - 1.0, windows / kMaximumOptimism);
}

using Recordings = std::vector<const FreeRuns*>;

/// What a step needs: slopes by the effects that a nominal boat may have; those by the others are
/// zero.
Sensitivity NominalSlopesOf(const FreeRuns& runs, const ChangedBoat& boat,
                            const UncertainModel& model,
                            const std::vector<EffectParameterRef>& parameter_refs,
                            std::size_t threads) {
  const NominalVariations variations = NominalVariationsOf(parameter_refs);
  std::vector<Eigen::Index> columns = variations.fixed;
  columns.insert(columns.end(), variations.weather.begin(), variations.weather.end());
  std::vector<EffectParameterRef> varying;
  for (const Eigen::Index j : columns)
    varying.push_back(parameter_refs[static_cast<std::size_t>(j)]);
  Sensitivity slopes = SensitivityOf(runs, boat, model, varying, threads, kSlopeStep);
  Eigen::MatrixXd by_effect_parameter =
      Eigen::MatrixXd::Zero(slopes.errors.size(), std::ssize(parameter_refs));
  by_effect_parameter(Eigen::all, columns) = slopes.by_effect_parameter;
  slopes.by_effect_parameter = std::move(by_effect_parameter);
  return slopes;
}

/// A boat, and what it leaves of the recordings.
struct BoatEstimate {
  MixedEffectsFit fit;  ///< that led to it
  AugmentedModel boat;
  std::vector<Eigen::MatrixXd> errors = {};
  std::vector<Eigen::MatrixXd> residuals = {};  ///< the errors less what weather did
  /// The generalised one of the residuals; infinite where no step led here.
  double variance = std::numeric_limits<double>::infinity();
};

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
        now_{.fit = {model, parameter_refs, recordings_.size()}, .boat = {model.model, {}}} {
    Outcome outcome = OutcomeOf(now_.boat);
    divergence_of_model_ = outcome.divergence;
    now_.errors = std::move(outcome.errors);
    now_.residuals = now_.errors;
    covariance_ = SecondMoment(now_.residuals);
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
        divergence_of_model_(baseline.divergence_of_model),
        now_{.fit = {model, parameter_refs, recordings_.size()}, .boat = baseline.boat},
        sensitivities_(std::move(slopes)),
        covariance_(baseline.covariance) {
    now_.fit.StartFrom(baseline.coefficients, baseline.fixed_effects);
    for (const Sensitivity& day : sensitivities_) now_.errors.push_back(day.errors);
    now_.residuals = now_.errors;
  }

  /// A step with new slopes, taken back where it leaves more. Whether it leaves less by enough to
  /// go on.
  bool Improve() {
    sensitivities_.clear();
    for (const FreeRuns* runs : recordings_) {
      sensitivities_.push_back(NominalSlopesOf(*runs, {now_.boat, now_.fit.Coefficients()}, model_,
                                               parameter_refs_, threads_));
    }
    const BoatEstimate before = now_;
    Step();
    if (now_.variance >= before.variance) now_ = before;
    return now_.variance < kConvergedRatio * before.variance;
  }

  /// A step with the slopes there are.
  void Step() {
    // Whitened by the scatter that the slopes predict to be left. The present scatter would count
    // what the boat still does wrong as noise.
    std::vector<Eigen::MatrixXd> predicted = now_.residuals;
    for (int round = 0; round < kRounds; ++round) {
      Reestimate(predicted);
      for (std::size_t day = 0; day < predicted.size(); ++day) {
        predicted[day] = now_.fit.PredictedResiduals(sensitivities_[day], day);
      }
      covariance_ = SecondMoment(predicted);
    }
    factor_.compute(covariance_);
    now_.residuals = LessWeather(now_.errors, now_.fit);
    now_.variance = GeneralisedVariance(now_.residuals);
    SearchAlongLine();
  }

  /// With new slopes over the whole typical size.
  NominalBaseline Baseline() {
    std::vector<Sensitivity> days;
    for (const FreeRuns* runs : recordings_) {
      days.push_back(SensitivityOf(*runs, {now_.boat, now_.fit.Coefficients()}, model_,
                                   parameter_refs_, threads_));
    }
    return Baseline(std::move(days));
  }

  /// With the slopes there are.
  NominalBaseline BaselineWithOldSlopes() {
    std::vector<Sensitivity> days = sensitivities_;
    for (std::size_t day = 0; day < days.size(); ++day) days[day].errors = now_.errors[day];
    return Baseline(std::move(days));
  }

 private:
  NominalBaseline Baseline(std::vector<Sensitivity> days) {
    covariance_ = SecondMoment(now_.residuals);
    Reestimate(now_.residuals);
    NominalBaseline nominal{.boat = now_.boat,
                            .coefficients = now_.fit.Coefficients(),
                            .fixed_effects = now_.fit.FixedEffects(),
                            .covariance = covariance_,
                            .kappa = kappa_,
                            .boat_covariance = now_.fit.BoatCovariance(),
                            .recording_effect_sd = now_.fit.WeatherSd(),
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

  void Reestimate(const std::vector<Eigen::MatrixXd>& residuals) {
    factor_.compute(covariance_);
    kappa_ = Kappa(factor_, residuals);
    now_.fit.Accumulate(sensitivities_, factor_, kappa_);
    now_.fit.Solve();
  }

  // Steps are longer than linear: a delay or a dead zone that is found moves much besides.
  void SearchAlongLine() {
    const BoatEstimate start = now_;
    for (const double share : kStepLengths) {
      std::optional<BoatEstimate> tried = After(share, start);
      if (tried && tried->variance < now_.variance) {
        now_ = *std::move(tried);
      } else if (now_.variance < start.variance) {
        break;
      }
    }
  }

  /// A share of a step from `start`. Nothing where it leads to a boat that diverges more than the
  /// model does.
  std::optional<BoatEstimate> After(double share, const BoatEstimate& start) const {
    MixedEffectsFit fit = start.fit;
    fit.Accept(share);
    const Eigen::VectorXd change = fit.Coefficients().cwiseProduct(model_.StandardErrors());
    AugmentedModel boat{model_.Changed(change), EffectsOf(parameter_refs_, fit.FixedEffects())};
    auto [errors, divergence] = OutcomeOf(boat);
    if (divergence.IsWorseThan(divergence_of_model_)) return std::nullopt;
    std::vector<Eigen::MatrixXd> residuals = LessWeather(errors, fit);
    const double variance = GeneralisedVariance(residuals);
    return BoatEstimate{std::move(fit), std::move(boat), std::move(errors), std::move(residuals),
                        variance};
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

  std::vector<Eigen::MatrixXd> LessWeather(const std::vector<Eigen::MatrixXd>& errors,
                                           const MixedEffectsFit& fit) const {
    std::vector<Eigen::MatrixXd> left;
    for (std::size_t day = 0; day < errors.size(); ++day) {
      left.push_back(fit.LessWeather(errors[day], sensitivities_[day], factor_, kappa_));
    }
    return left;
  }

  Recordings recordings_;
  Recordings others_;
  const UncertainModel& model_;
  const std::vector<EffectParameterRef>& parameter_refs_;
  std::size_t threads_;
  Divergence divergence_of_model_;
  BoatEstimate now_;
  std::vector<Sensitivity> sensitivities_;
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
