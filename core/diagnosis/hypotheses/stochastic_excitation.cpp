#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/scatter_fit.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"

namespace telltale {
namespace {

std::vector<ScatterFit> FitBands(const std::vector<FrequencyResponse::Band>& bands,
                                 const ResidualMetric& metric, const Eigen::MatrixXd& windows,
                                 std::size_t threads) {
  std::vector<ScatterFit> fits(bands.size());
  ForEachIndex(bands.size(), threads, [&](std::size_t i) {
    ResponseMoments moments;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moments[axis] = metric.WhitenMoment(bands[i].patterns[axis]);
    }
    fits[i] = FitScatter(windows, moments);
  });
  return fits;
}

bool IsLessLikely(const ScatterFit& a, const ScatterFit& b) {
  return a.log_likelihood_ratios.sum() < b.log_likelihood_ratios.sum();
}

/// 2 ln of the likelihood ratio that counts as evidence. Scatter that grew for another reason is
/// likelier at an end of the range than in between, so the gain over the likelier end counts, times
/// the narrow-band factor.
double NarrowBandGain(const std::vector<ScatterFit>& fits, const ScatterFit& best,
                      const ResidualMetric& metric, const FreeRuns& runs) {
  const ScatterFit& end = std::max(fits.front(), fits.back(), IsLessLikely);
  std::vector<std::size_t> blocks;
  const std::vector<std::size_t> all_blocks = BlocksOf(runs);
  for (const std::size_t w : metric.Windows()) blocks.push_back(all_blocks[w]);
  const double narrow =
      PersistentSum(best.log_likelihood_ratios - end.log_likelihood_ratios, blocks);
  const bool persists = PersistentSum(best.log_likelihood_ratios, blocks) > 0.0;
  if (!persists) return 0.0;
  return std::clamp(kDiagnosis.stochastic_excitation.narrow_band_factor * narrow, 0.0,
                    best.log_likelihood_ratios.sum());
}

ModelledEffect EffectOf(const Effect& effect, const ScatterFit& fit, double frequency_rad_s) {
  ModelledEffect modelled{&effect, {}};
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto& parameter = effect.Parameters()[static_cast<std::size_t>(j)];
    modelled.values.push_back(
        std::clamp(std::sqrt(fit.squared_amplitudes[j]), parameter.lower, parameter.upper));
  }
  modelled.values.push_back(frequency_rad_s);
  return modelled;
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

EffectFit FitStochasticExcitation(const Effect& effect, const DiagnosisProblem& problem,
                                  const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                                  std::size_t threads) {
  const Eigen::VectorXd whitened = metric.Whiten(errors);
  const std::vector<FrequencyResponse::Band>& bands = problem.frequency_response.Of(effect);
  const std::vector<ScatterFit> fits =
      FitBands(bands, metric, metric.UnexplainedByWindow(whitened), threads);
  const auto best = std::max_element(fits.begin(), fits.end(), IsLessLikely);
  const double gain = NarrowBandGain(fits, *best, metric, problem.runs);
  const auto& band = bands[static_cast<std::size_t>(best - fits.begin())];

  EffectFit fit;
  fit.effects = {EffectOf(effect, *best, band.frequency_rad_s)};
  // The relative standard error of a size is one over the root of the effective observations.
  fit.covariance = Eigen::MatrixXd::Zero(4, 4);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const double value = fit.effects.front().values[static_cast<std::size_t>(j)];
    fit.covariance(j, j) = value * value / metric.EffectiveObservations();
  }
  const double none = metric.SquaredMahalanobis(whitened);
  const double least = kDiagnosis.stochastic_excitation.minimum_remaining_share * none;
  fit.score = metric.Deviance(std::max(none - metric.Kappa() * gain, least), none) +
              static_cast<double>(effect.Parameters().size()) * metric.ParameterPenalty();
  fit.square = gain > 0.0 ? metric.Kappa() * best->square : none;
  fit.errors = errors;
  return fit;
}

EffectFit WithStochasticEffect(const EffectFit& deterministic, const EffectFit& stochastic) {
  EffectFit both = stochastic;
  both.effects.insert(both.effects.begin(), deterministic.effects.begin(),
                      deterministic.effects.end());
  const Eigen::Index first = deterministic.covariance.rows();
  const Eigen::Index all = first + stochastic.covariance.rows();
  both.covariance = Eigen::MatrixXd::Zero(all, all);
  both.covariance.topLeftCorner(first, first) = deterministic.covariance;
  both.covariance.bottomRightCorner(all - first, all - first) = stochastic.covariance;
  both.score += deterministic.score;
  return both;
}

Eigen::VectorXd StochasticMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                      const AugmentedModel& boat) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(runs.Rows());
  if (fit.gusts.size() > 0) squares += GustMeanSquares(fit, runs, boat);
  for (const auto& [effect, values] : fit.effects) {
    const auto stochastic = effect->StochasticExcitation(values);
    if (!stochastic) continue;
    const ResponseMoments moments =
        ResponseMomentsAt(stochastic->frequency_rad_s, runs, boat, runs.Errors(boat));
    const Eigen::Array3d amplitudes = stochastic->amplitude;
    squares += ExcessCovariance(amplitudes.square(), moments).diagonal();
  }
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
