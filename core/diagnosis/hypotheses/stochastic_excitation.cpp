#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"

namespace telltale {
namespace {

constexpr int kIterations = 40;
// What the best frequency gains over the ends of the range counts so many times: scatter that grew
// in any other way gains as much at an end, and peaks nowhere between.
constexpr double kNarrowBandFactor = 50.0;

/// Windows whose errors scatter by I + excess.
struct Spectrum {
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();  ///< of amplitudes
  Eigen::VectorXd gains;  ///< by window, 2 ln of the likelihood over health's
  double left = 0.0;      ///< squares of all windows in what they scatter by
};

Eigen::MatrixXd ExcessOf(const Eigen::Vector3d& squares, const ResponseMoments& patterns) {
  return squares[0] * patterns[0] + squares[1] * patterns[1] + squares[2] * patterns[2];
}

/// Most likely squared amplitudes, by the multiplicative form of Fisher scoring that keeps them
/// positive.
Spectrum Fitted(const Eigen::MatrixXd& windows, const ResponseMoments& patterns) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(windows.rows(), windows.rows());
  const Eigen::MatrixXd moment = OfRoot(windows) / static_cast<double>(windows.cols());
  Spectrum spectrum;
  for (std::size_t j = 0; j < 3; ++j) {
    spectrum.squares[static_cast<Eigen::Index>(j)] =
        0.1 * moment.trace() / std::max(patterns[j].trace(), 1e-12);
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::MatrixXd scatter = identity + ExcessOf(spectrum.squares, patterns);
    const Eigen::MatrixXd inverse = Inverse(scatter);
    const Eigen::MatrixXd seen = Mapped(inverse, moment);
    for (std::size_t j = 0; j < 3; ++j) {
      const double wanted = (seen.array() * patterns[j].array()).sum();
      const double expected = (inverse.array() * patterns[j].array()).sum();
      spectrum.squares[static_cast<Eigen::Index>(j)] *=
          std::sqrt(wanted / std::max(expected, 1e-300));
    }
  }
  const Eigen::MatrixXd scatter = identity + ExcessOf(spectrum.squares, patterns);
  const Eigen::LLT<Eigen::MatrixXd> factor(scatter);
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  const Eigen::VectorXd left = factor.matrixL().solve(windows).colwise().squaredNorm();
  spectrum.left = left.sum();
  spectrum.gains = windows.colwise().squaredNorm().transpose() - left;
  spectrum.gains.array() -= log_determinant;
  return spectrum;
}

/// The sum over windows if all were like those of a half minute that three of four surpass: what
/// some windows show and others do not goes on only now and then.
double PersistentSum(const Eigen::VectorXd& values, const std::vector<std::size_t>& blocks) {
  std::vector<double> means;
  for (const auto& [sum, count] :
       SumsByBlock(values, Eigen::VectorXd::Ones(values.size()), blocks)) {
    means.push_back(sum / count);
  }
  const auto quarter = means.begin() + std::ssize(means) / 4;
  std::nth_element(means.begin(), quarter, means.end());
  return *quarter * static_cast<double>(values.size());
}

}  // namespace

EffectFit FitStochasticExcitation(const Effect& effect, const DiagnosisProblem& problem,
                                  const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                                  std::size_t threads) {
  const Eigen::VectorXd seen = metric.Whiten(errors);
  const Eigen::MatrixXd windows = metric.UnexplainedByWindow(seen);
  const std::vector<FrequencyResponse::Band>& bands = problem.frequency_response.Of(effect);
  std::vector<Spectrum> spectra(bands.size());
  ForEachIndex(bands.size(), threads, [&](std::size_t i) {
    ResponseMoments patterns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      patterns[axis] = metric.WhitenMoment(bands[i].patterns[axis]);
    }
    spectra[i] = Fitted(windows, patterns);
  });
  const auto gains_less = [](const Spectrum& a, const Spectrum& b) {
    return a.gains.sum() < b.gains.sum();
  };
  const auto best = std::max_element(spectra.begin(), spectra.end(), gains_less);
  const Spectrum& end = std::max(spectra.front(), spectra.back(), gains_less);

  std::vector<std::size_t> blocks;
  const std::vector<std::size_t> all_blocks = BlocksOf(problem.runs);
  for (const std::size_t w : metric.Windows()) blocks.push_back(all_blocks[w]);
  const double narrow = PersistentSum(best->gains - end.gains, blocks);
  const bool lasts = PersistentSum(best->gains, blocks) > 0.0;
  const double gain = lasts ? std::clamp(kNarrowBandFactor * narrow, 0.0, best->gains.sum()) : 0.0;

  EffectFit fit;
  ModelledEffect& modelled = fit.effects.emplace_back(ModelledEffect{&effect, {}});
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto& parameter = effect.Parameters()[static_cast<std::size_t>(j)];
    modelled.values.push_back(
        std::clamp(std::sqrt(best->squares[j]), parameter.lower, parameter.upper));
  }
  const auto found = static_cast<std::size_t>(best - spectra.begin());
  modelled.values.push_back(bands[found].frequency_rad_s);
  // A root of the looks is what random waves leave open of their own size.
  fit.covariance = Eigen::MatrixXd::Zero(4, 4);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const double value = modelled.values[static_cast<std::size_t>(j)];
    fit.covariance(j, j) = value * value / metric.EffectiveObservations();
  }
  const double none = metric.SquaredMahalanobis(seen);
  fit.score = metric.Deviance(std::max(none - metric.Kappa() * gain, 0.01 * none), none) +
              4.0 * std::log(std::max(metric.EffectiveObservations(), 2.0));
  fit.square = gain > 0.0 ? metric.Kappa() * best->left : none;
  fit.errors = errors;
  return fit;
}

EffectFit WithStochasticEffect(const EffectFit& moving, const EffectFit& stochastic) {
  EffectFit both = stochastic;
  both.effects.insert(both.effects.begin(), moving.effects.begin(), moving.effects.end());
  const Eigen::Index first = moving.covariance.rows();
  const Eigen::Index all = first + stochastic.covariance.rows();
  both.covariance = Eigen::MatrixXd::Zero(all, all);
  both.covariance.topLeftCorner(first, first) = moving.covariance;
  both.covariance.bottomRightCorner(all - first, all - first) = stochastic.covariance;
  both.score += moving.score;
  return both;
}

EffectFit Refit(const EffectFit& fit, const DiagnosisProblem& problem, const ResidualMetric& metric,
                std::size_t threads) {
  EffectFit moving = fit;
  std::erase_if(moving.effects,
                [](const auto& modelled) { return modelled.effect->IsStochastic(); });
  if (!moving.effects.empty()) {
    moving =
        FitEffects(problem.runs, problem.nominal.boat, metric, moving.Effects(), {moving.Values()});
  }
  if (moving.effects.size() == fit.effects.size()) return moving;
  const bool alone = moving.effects.empty();
  const EffectFit stochastic =
      FitStochasticExcitation(*fit.effects.back().effect, problem, metric,
                              alone ? problem.recording.errors : moving.errors, threads);
  return alone ? stochastic : WithStochasticEffect(moving, stochastic);
}

Eigen::VectorXd StochasticMeanSquares(const EffectFit& fit, const FreeRuns& runs,
                                      const AugmentedModel& boat) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(runs.Rows());
  for (const auto& [effect, values] : fit.effects) {
    const auto stochastic = effect->StochasticExcitation(values);
    if (!stochastic) continue;
    const ResponseMoments patterns =
        ResponseMomentsAt(stochastic->frequency_rad_s, runs, boat, runs.Errors(boat));
    const Eigen::Array3d amplitudes = stochastic->amplitude;
    squares += ExcessOf(amplitudes.square(), patterns).diagonal();
  }
  return squares;
}

double StochasticDetectability(const Effect& effect, const DiagnosisProblem& problem) {
  const auto parameters = effect.Parameters();
  const ResponseMoments patterns = ResponseMomentsAt(
      parameters[3].prior_mean, problem.runs, problem.nominal.boat, problem.recording.errors);
  double excess = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double amplitude = parameters[axis].typical;
    excess += amplitude * amplitude * problem.metric.WhitenMoment(patterns[axis]).trace();
  }
  const auto rows = static_cast<double>(problem.runs.Rows());
  return std::sqrt(std::max(problem.metric.Deviance(rows + excess, rows), 0.0));
}

}  // namespace telltale
