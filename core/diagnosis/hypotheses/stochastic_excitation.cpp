#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/variation.hpp"
#include "telltale/core/diagnosis/residuals/frequency_response.hpp"

namespace telltale {
namespace {

constexpr double kNoAmplitude = 1e-9;

/// The peak with so many times its power.
SpectralPeak Scaled(SpectralPeak peak, double factor) {
  peak.squared_amplitudes *= factor;
  peak.standard_errors *= factor;
  return peak;
}

ModelledEffect EffectOf(const Effect& effect, const SpectralPeak& peak) {
  ModelledEffect modelled{&effect, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const EffectParameter& parameter = effect.Parameters()[axis];
    const double amplitude = std::sqrt(peak.squared_amplitudes[static_cast<Eigen::Index>(axis)]);
    modelled.values.push_back(std::clamp(amplitude, parameter.lower, parameter.upper));
  }
  modelled.values.push_back(peak.frequency_rad_s);
  return modelled;
}

Eigen::MatrixXd CovarianceOf(const SpectralPeak& peak) {
  Eigen::Vector4d standard_errors;
  standard_errors << peak.standard_errors.array() /
                         (2.0 * peak.squared_amplitudes.array().sqrt()).max(kNoAmplitude),
      peak.frequency_standard_error_rad_s;
  return standard_errors.cwiseAbs2().asDiagonal();
}

/// The errors of a recording by a metric that allows for scatter.
struct ScatteredSquare {
  double square = 0.0;
  double penalty = 0.0;  ///< the growth of ln of the determinant, in squares
  double Deviance() const { return square + penalty; }  ///< -2 ln likelihood
};

ScatteredSquare SquareWith(const Eigen::MatrixXd& scatter, const ResidualMetric& metric,
                           const Eigen::MatrixXd& errors) {
  const ResidualMetric scattered = metric.WithWindowScatter(scatter);
  return {scattered.SquaredMahalanobis(scattered.Whiten(errors)),
          (scattered.VariationPenalty() - metric.VariationPenalty()) * metric.ExpectedSquare() /
              metric.EffectiveObservations()};
}

/// By how much the windows scatter more than the spectrum says: the likeliest of a few factors.
double LikeliestFactor(const Eigen::MatrixXd& scatter, const ResidualMetric& metric,
                       const Eigen::MatrixXd& errors) {
  double likeliest = 1.0;
  if (scatter.isZero(0.0)) return likeliest;
  double least = std::numeric_limits<double>::infinity();
  for (const double factor : kDiagnosis.stochastic_excitation.factors) {
    const double deviance = SquareWith(factor * scatter, metric, errors).Deviance();
    if (deviance < least) {
      least = deviance;
      likeliest = factor;
    }
  }
  return likeliest;
}

/// Both together, the deterministic effects fitted by the metric that the stochastic one widens.
EffectFit Together(const EffectFit& deterministic, const EffectFit& stochastic) {
  EffectFit both = deterministic;
  both.effects.insert(both.effects.end(), stochastic.effects.begin(), stochastic.effects.end());
  const Eigen::Index first = deterministic.covariance.rows();
  const Eigen::Index all = first + stochastic.covariance.rows();
  both.covariance = Eigen::MatrixXd::Zero(all, all);
  both.covariance.topLeftCorner(first, first) = deterministic.covariance;
  both.covariance.bottomRightCorner(all - first, all - first) = stochastic.covariance;
  both.scatter = stochastic.scatter;
  both.score += stochastic.score;
  return both;
}

/// Errors grow most by the lowest frequencies of a peak, and those of encounter change with the
/// heading: the widest shape counts.
ResponseMoments MomentsOf(const SpectralPeak& peak, const FreeRuns& runs,
                          const AugmentedModel& boat, const Eigen::MatrixXd& errors) {
  return MeanResponseMomentsOf(peak.frequency_rad_s, kDiagnosis.spectral_peak.log_widths.back(),
                               runs, boat, errors);
}

SpectralPeak PeakOver(const std::vector<AccelerationSpectra>& nominal, const Effect& effect,
                      const FreeRuns& runs, const AugmentedModel& boat) {
  const EffectParameter& frequency = effect.Parameters()[3];
  return LikeliestPeak(AccelerationSpectraOf(runs.Dataset(), boat), nominal, frequency.lower,
                       frequency.upper);
}

/// The excitation of a peak, whose moments are asked for where there is one.
ObservedExcitation ExcitationOf(const SpectralPeak& peak, Eigen::Index rows,
                                const std::function<ResponseMoments()>& moments) {
  ObservedExcitation observed;
  observed.peak = peak;
  observed.scatter = Eigen::MatrixXd::Zero(rows, rows);
  if (peak.gain == 0.0) return observed;
  observed.moments = moments();
  observed.scatter = ErrorCovarianceBy(observed.moments, peak.squared_amplitudes);
  return observed;
}

/// What gusts, drifts and spells add to the mean square of each row.
Eigen::VectorXd VariationMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                     const AugmentedModel& boat) {
  const Eigen::MatrixXd errors = runs.Errors(boat.With(fit.effects));
  const ErrorVariation variation = VariationOf(fit.effects, fit.intermittent_sd, errors,
                                               ErrorModelOf(runs, boat), runs.HorizonS());
  const Eigen::VectorXd squares =
      variation.by_window.rowwise().squaredNorm() + variation.drifting.rowwise().squaredNorm();
  return squares.reshaped(errors.rows(), errors.cols()).rowwise().mean();
}

}  // namespace

ObservedExcitation ObservedExcitationOf(std::span<const Effect* const> library,
                                        const FreeRuns& runs,
                                        const std::vector<PreparedDataset>& references,
                                        const AugmentedModel& boat, const Eigen::MatrixXd& errors) {
  const auto effect = std::ranges::find_if(library, &Effect::IsStochastic);
  if (effect == library.end()) return {};
  std::vector<AccelerationSpectra> nominal;
  for (const PreparedDataset& reference : references) {
    nominal.push_back(AccelerationSpectraOf(reference, boat));
  }
  const SpectralPeak peak = PeakOver(nominal, **effect, runs, boat);
  ObservedExcitation observed =
      ExcitationOf(peak, errors.rows(), [&] { return MomentsOf(peak, runs, boat, errors); });
  observed.nominal = std::move(nominal);
  return observed;
}

SpectralPeak PeakBeside(const Effect& stochastic, const std::vector<ModelledEffect>& effects,
                        const DiagnosisProblem& problem) {
  return PeakOver(problem.excitation.nominal, stochastic, problem.runs,
                  problem.nominal.boat.With(effects));
}

ObservedExcitation ExcitationBeside(const Effect& stochastic,
                                    const std::vector<ModelledEffect>& effects,
                                    const DiagnosisProblem& problem) {
  const ObservedExcitation& alone = problem.excitation;
  const AugmentedModel boat = problem.nominal.boat.With(effects);
  const SpectralPeak peak = PeakBeside(stochastic, effects, problem);
  // Effects hardly change how the boat answers waves of the same frequency.
  const bool is_known = alone.peak.gain > 0.0 && alone.peak.frequency_rad_s == peak.frequency_rad_s;
  return ExcitationOf(peak, problem.runs.Rows(), [&] {
    return is_known ? alone.moments
                    : MomentsOf(peak, problem.runs, boat, problem.runs.Errors(boat));
  });
}

EffectFit FitStochasticExcitation(const Effect& effect, const ObservedExcitation& observed,
                                  const DiagnosisProblem& problem, const ResidualMetric& metric,
                                  const Eigen::MatrixXd& left) {
  const double factor = LikeliestFactor(observed.scatter, metric, left);
  const SpectralPeak peak = Scaled(observed.peak, factor);
  EffectFit fit;
  fit.effects = {EffectOf(effect, peak)};
  fit.covariance = CovarianceOf(peak);
  fit.errors = problem.recording.errors;
  fit.scatter = factor * observed.scatter;
  const ScatteredSquare with = SquareWith(fit.scatter, metric, fit.errors);
  const double none = metric.SquaredMahalanobis(metric.Whiten(fit.errors));
  fit.square = with.square;
  // Of its parameters the factor alone is fitted to the windows.
  const double evidence = metric.Deviance(with.Deviance(), none);
  fit.score = std::max(evidence + metric.ParameterPenalty(), -peak.gain);
  return fit;
}

EffectFit FitBeside(const Effect& stochastic, const DiagnosisProblem& problem,
                    const ResidualMetric& metric, const std::vector<const Effect*>& effects,
                    const Eigen::VectorXd& start) {
  const ErrorModel error_model = ErrorModelOf(problem.runs, problem.nominal.boat);
  const auto fit_given = [&](const EffectFit& scatter, const Eigen::VectorXd& from) {
    return FitEffects(error_model, scatter.ScatteredMetric(metric), effects, {from});
  };
  const EffectFit first = fit_given(FitStochasticExcitation(stochastic, problem.excitation, problem,
                                                            metric, problem.recording.errors),
                                    start);
  const EffectFit left =
      FitStochasticExcitation(stochastic, ExcitationBeside(stochastic, first.effects, problem),
                              problem, metric, first.errors);
  return Together(fit_given(left, first.Values()), left);
}

Eigen::MatrixXd ScatterOf(const std::vector<ModelledEffect>& effects, const FreeRuns& runs,
                          const AugmentedModel& boat) {
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(runs.Rows(), runs.Rows());
  for (const auto& [effect, values] : effects) {
    const auto excitation = effect->StochasticExcitation(values);
    if (!excitation) continue;
    SpectralPeak peak;
    peak.frequency_rad_s = excitation->frequency_rad_s;
    peak.squared_amplitudes = excitation->amplitude.cwiseAbs2();
    scatter +=
        ErrorCovarianceBy(MomentsOf(peak, runs, boat, runs.Errors(boat)), peak.squared_amplitudes);
  }
  return scatter;
}

Eigen::VectorXd StochasticMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                      const AugmentedModel& boat) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(runs.Rows());
  if (!fit.variation.IsEmpty()) squares += VariationMeanSquares(fit, runs, boat);
  if (fit.Stochastic() != nullptr) squares += fit.scatter.diagonal();
  return squares;
}

double StochasticDetectability(const Effect& effect, const DiagnosisProblem& problem) {
  const auto parameters = effect.Parameters();
  const ResponseMoments moments = ResponseMomentsAt(parameters[3].prior_mean, problem.runs,
                                                    problem.nominal.boat, problem.recording.errors);
  double excess = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double amplitude = parameters[axis].typical;
    excess += amplitude * amplitude * problem.metric.WhitenMoment(moments[axis]).trace();
  }
  const auto rows = static_cast<double>(problem.runs.Rows());
  return std::sqrt(std::max(problem.metric.Deviance(rows + excess, rows), 0.0));
}

}  // namespace telltale
