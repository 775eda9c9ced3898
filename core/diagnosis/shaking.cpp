#include "diagnosis/shaking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>

#include "contract.hpp"
#include "diagnosis/gap.hpp"
#include "parallel.hpp"

namespace telltale {
namespace {

constexpr std::size_t kFrequencies = 12;
constexpr int kIterations = 40;
// What the best frequency gains over the ends of the range counts so many times: scatter that grew
// in any other way gains as much at an end, and peaks nowhere between.
constexpr double kNarrow = 20.0;

/// Pushes along one axis at one frequency and phase, an acceleration of one.
class Swing final : public Effect {
 public:
  Swing(std::size_t axis, double frequency_rad_s, double phase_rad)
      : Effect({.name = "swing",
                .title = "",
                .equation = "",
                .source = "",
                .parameters = {},
                .settled_by = "",
                .hook = Hook::kPush}),
        axis_(axis),
        frequency_rad_s_(frequency_rad_s),
        phase_rad_(phase_rad) {}

  std::string Describe(EffectValues) const override { return ""; }

  NuDot Push(EffectValues, const Moment& moment) const override {
    const double push = kPush * std::cos(frequency_rad_s_ * moment.time_s + phase_rad_);
    return {axis_ == 0 ? push : 0.0, axis_ == 1 ? push : 0.0, axis_ == 2 ? push : 0.0};
  }

  static constexpr double kPush = 0.05;  // small enough to stay linear

 private:
  std::size_t axis_;
  double frequency_rad_s_;
  double phase_rad_;
};

/// Mean over windows of the outer product of errors that a unit amplitude of random phase leaves.
Eigen::MatrixXd PatternOf(const FreeRuns& runs, const AugmentedModel& boat,
                          const Eigen::MatrixXd& nominal, std::size_t axis, double frequency) {
  Eigen::MatrixXd pattern = Eigen::MatrixXd::Zero(nominal.rows(), nominal.rows());
  for (const double phase : {0.0, -std::numbers::pi / 2.0}) {
    const Swing swing(axis, frequency, phase);
    const ModelledEffect shaking{&swing, {}};
    const Eigen::MatrixXd response =
        (runs.Errors(boat.With({&shaking, 1})) - nominal) / Swing::kPush;
    pattern += 0.5 * response * response.transpose() / static_cast<double>(nominal.cols());
  }
  return pattern;
}

/// Windows whose errors scatter by I + excess.
struct Spectrum {
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();  ///< of amplitudes
  Eigen::VectorXd gains;  ///< by window, 2 ln of the likelihood over health's
  double left = 0.0;      ///< squares of all windows in what they scatter by
};

Eigen::MatrixXd ExcessOf(const Eigen::Vector3d& squares,
                         const std::array<Eigen::MatrixXd, 3>& patterns) {
  return squares[0] * patterns[0] + squares[1] * patterns[1] + squares[2] * patterns[2];
}

/// Most likely squared amplitudes, by the multiplicative form of Fisher scoring that keeps them
/// positive.
Spectrum Fitted(const Eigen::MatrixXd& windows, const std::array<Eigen::MatrixXd, 3>& patterns) {
  const auto identity = Eigen::MatrixXd::Identity(windows.rows(), windows.rows());
  const Eigen::MatrixXd moment =
      windows * windows.transpose() / static_cast<double>(windows.cols());
  Spectrum spectrum;
  for (std::size_t j = 0; j < 3; ++j) {
    spectrum.squares[static_cast<Eigen::Index>(j)] =
        0.1 * moment.trace() / std::max(patterns[j].trace(), 1e-12);
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::LLT<Eigen::MatrixXd> scatter(identity + ExcessOf(spectrum.squares, patterns));
    const Eigen::MatrixXd inverse = scatter.solve(identity);
    const Eigen::MatrixXd seen = inverse * moment * inverse;
    for (std::size_t j = 0; j < 3; ++j) {
      const double wanted = (seen.array() * patterns[j].array()).sum();
      const double expected = (inverse.array() * patterns[j].array()).sum();
      spectrum.squares[static_cast<Eigen::Index>(j)] *=
          std::sqrt(wanted / std::max(expected, 1e-300));
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> scatter(identity + ExcessOf(spectrum.squares, patterns));
  const double log_determinant = 2.0 * scatter.matrixLLT().diagonal().array().log().sum();
  const Eigen::VectorXd left = scatter.matrixL().solve(windows).colwise().squaredNorm();
  spectrum.left = left.sum();
  spectrum.gains = windows.colwise().squaredNorm().transpose() - left;
  spectrum.gains.array() -= log_determinant;
  return spectrum;
}

/// The sum over windows if all were like those of a half minute that three of four surpass: what
/// some windows show and others do not goes on only now and then.
double LastingSum(const Eigen::VectorXd& values, const std::vector<std::size_t>& blocks) {
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

EffectFit FitShaking(const Effect& effect, const FreeRuns& runs, const AugmentedModel& boat,
                     const Judge& judge, const Eigen::MatrixXd& errors, std::size_t threads) {
  const auto parameters = effect.Parameters();
  Require(parameters.size() == 4, "three amplitudes and a frequency");
  const Eigen::VectorXd seen = judge.See(errors);
  const Eigen::MatrixXd windows = judge.UnexplainedByWindow(seen);
  const Eigen::MatrixXd nominal = runs.Errors(boat);
  const auto frequency = [&](std::size_t i) {
    const double share = static_cast<double>(i) / static_cast<double>(kFrequencies - 1);
    return parameters[3].lower * std::pow(parameters[3].upper / parameters[3].lower, share);
  };
  std::array<Spectrum, kFrequencies> spectra;
  ForEachIndex(kFrequencies, threads, [&](std::size_t i) {
    std::array<Eigen::MatrixXd, 3> patterns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      patterns[axis] = judge.Whiten(PatternOf(runs, boat, nominal, axis, frequency(i)));
    }
    spectra[i] = Fitted(windows, patterns);
  });
  const auto gains_less = [](const Spectrum& a, const Spectrum& b) {
    return a.gains.sum() < b.gains.sum();
  };
  const auto best = std::max_element(spectra.begin(), spectra.end(), gains_less);
  const Spectrum& end = std::max(spectra.front(), spectra.back(), gains_less);

  std::vector<std::size_t> blocks;
  const std::vector<std::size_t> all_blocks = BlocksOf(runs);
  for (const std::size_t w : judge.Windows()) blocks.push_back(all_blocks[w]);
  const double narrow = LastingSum(best->gains - end.gains, blocks);
  const double gain = std::clamp(kNarrow * narrow, 0.0, std::max(best->gains.sum(), 0.0));

  EffectFit fit;
  ModelledEffect& modelled = fit.effects.emplace_back(ModelledEffect{&effect, {}});
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto& parameter = parameters[static_cast<std::size_t>(j)];
    modelled.values.push_back(
        std::clamp(std::sqrt(best->squares[j]), parameter.lower, parameter.upper));
  }
  modelled.values.push_back(frequency(static_cast<std::size_t>(best - spectra.begin())));
  // A root of the looks is what random waves leave open of their own size.
  fit.covariance = Eigen::MatrixXd::Zero(4, 4);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const double value = modelled.values[static_cast<std::size_t>(j)];
    fit.covariance(j, j) = value * value / judge.Looks();
  }
  const double none = judge.Square(seen);
  fit.score = judge.Evidence(std::max(none - judge.Kappa() * gain, 0.01 * none), none) +
              4.0 * std::log(std::max(judge.Looks(), 2.0));
  fit.square = gain > 0.0 ? judge.Kappa() * best->left : none;
  fit.errors = errors;
  return fit;
}

EffectFit Beside(const EffectFit& moving, const EffectFit& shaking) {
  EffectFit both = shaking;
  both.effects.insert(both.effects.begin(), moving.effects.begin(), moving.effects.end());
  const Eigen::Index first = moving.covariance.rows();
  const Eigen::Index all = first + shaking.covariance.rows();
  both.covariance = Eigen::MatrixXd::Zero(all, all);
  both.covariance.topLeftCorner(first, first) = moving.covariance;
  both.covariance.bottomRightCorner(all - first, all - first) = shaking.covariance;
  both.score += moving.score;
  return both;
}

EffectFit FitAgain(const EffectFit& fit, const FreeRuns& runs, const AugmentedModel& boat,
                   const Judge& judge, std::size_t threads) {
  EffectFit moving = fit;
  std::erase_if(moving.effects, [](const auto& modelled) { return modelled.effect->Shakes(); });
  if (!moving.effects.empty()) {
    moving = FitEffects(runs, boat, judge, moving.Effects(), {moving.Values()});
  }
  if (moving.effects.size() == fit.effects.size()) return moving;
  const bool alone = moving.effects.empty();
  const EffectFit shaking = FitShaking(*fit.effects.back().effect, runs, boat, judge,
                                       alone ? runs.Errors(boat) : moving.errors, threads);
  return alone ? shaking : Beside(moving, shaking);
}

Eigen::VectorXd ShakenSquares(const EffectFit& fit, const FreeRuns& runs,
                              const AugmentedModel& boat) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(runs.Rows());
  const Eigen::MatrixXd nominal = runs.Errors(boat);
  for (const auto& [effect, values] : fit.effects) {
    const auto shaking = effect->Shaking(values);
    if (!shaking) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double amplitude = shaking->amplitude[static_cast<Eigen::Index>(axis)];
      squares += amplitude * amplitude *
                 PatternOf(runs, boat, nominal, axis, shaking->frequency_rad_s).diagonal();
    }
  }
  return squares;
}

double ShakingDetectability(const Effect& effect, const FreeRuns& runs, const AugmentedModel& boat,
                            const Judge& judge) {
  const auto parameters = effect.Parameters();
  const Eigen::MatrixXd nominal = runs.Errors(boat);
  double excess = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double amplitude = parameters[axis].typical;
    excess += amplitude * amplitude *
              judge.Whiten(PatternOf(runs, boat, nominal, axis, parameters[3].usual)).trace();
  }
  const double rows = static_cast<double>(runs.Rows());
  return std::sqrt(std::max(judge.Evidence(rows + excess, rows), 0.0));
}

}  // namespace telltale
