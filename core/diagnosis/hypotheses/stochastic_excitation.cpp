#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
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

/// What the accelerations of a peak add to the covariance of a window's errors. Errors grow most by
/// the lowest frequencies, and those of encounter change with the heading: the widest shape counts.
Eigen::MatrixXd ScatterOfPeak(SpectralPeak peak, const FreeRuns& runs, const AugmentedModel& boat,
                              const Eigen::MatrixXd& errors) {
  peak.log_width = kDiagnosis.spectral_peak.log_widths.back();
  return ErrorCovarianceOf(peak, runs, boat, errors);
}

/// The peak over the references' spectra, and the scatter by it.
ObservedExcitation ExcitationOver(std::vector<AccelerationSpectra> nominal, const Effect& effect,
                                  const FreeRuns& runs, const AugmentedModel& boat,
                                  const Eigen::MatrixXd& errors) {
  const EffectParameter& frequency = effect.Parameters()[3];
  ObservedExcitation observed;
  observed.peak = LikeliestPeak(AccelerationSpectraOf(runs.Dataset(), boat), nominal,
                                frequency.lower, frequency.upper);
  observed.scatter = observed.peak.gain > 0.0 ? ScatterOfPeak(observed.peak, runs, boat, errors)
                                              : Eigen::MatrixXd::Zero(errors.rows(), errors.rows());
  observed.nominal = std::move(nominal);
  return observed;
}

/// What gusts add to the mean square of each row.
Eigen::VectorXd GustMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                const AugmentedModel& boat) {
  const Eigen::MatrixXd errors = runs.Errors(boat.With(fit.effects));
  const Eigen::VectorXd squares =
      GustsOf(fit.effects, errors, ErrorModelOf(runs, boat), runs.HorizonS())
          .rowwise()
          .squaredNorm();
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
  return ExcitationOver(std::move(nominal), **effect, runs, boat, errors);
}

ObservedExcitation ExcitationBeside(const Effect& stochastic,
                                    const std::vector<ModelledEffect>& effects,
                                    const DiagnosisProblem& problem) {
  const AugmentedModel boat = problem.nominal.boat.With(effects);
  return ExcitationOver(problem.excitation.nominal, stochastic, problem.runs, boat,
                        problem.runs.Errors(boat));
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
    scatter += ScatterOfPeak(peak, runs, boat, runs.Errors(boat));
  }
  return scatter;
}

Eigen::VectorXd StochasticMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                      const AugmentedModel& boat) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(runs.Rows());
  if (fit.gusts.size() > 0) squares += GustMeanSquares(fit, runs, boat);
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
