#include "diagnosis/shaking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include "contract.hpp"
#include "parallel.hpp"

namespace telltale {
namespace {

constexpr std::size_t kFrequencies = 12;
constexpr int kIterations = 60;
// Seas differ from day to day: times what the roughest healthy day would gain is no finding yet.
constexpr double kBeyondHealthy = 2.0;
// And so much more, since healthy days have shaped the scatter by which they are judged: no healthy
// development case gained as much.
constexpr double kNeverInHealth = 300.0;
// Waves scatter errors more than they enlarge them.
constexpr double kSizeCounts = 5.0;

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
    AugmentedModel shaken = boat;
    shaken.effects.push_back({&swing, {}});
    const Eigen::MatrixXd response = (runs.Errors(shaken) - nominal) / Swing::kPush;
    pattern += 0.5 * response * response.transpose() / static_cast<double>(nominal.cols());
  }
  return pattern;
}

struct Spectrum {
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();  ///< of amplitudes
  double explained = 0.0;                             ///< of the squares of all windows
  double gain = 0.0;                                  ///< 2 ln of the likelihood over health's
};

/// 2 ln likelihood of windows of second moment S under I + excess, over that under I.
double GainOf(const Eigen::MatrixXd& moment, const Eigen::MatrixXd& excess, double windows) {
  const auto identity = Eigen::MatrixXd::Identity(moment.rows(), moment.rows());
  const Eigen::LLT<Eigen::MatrixXd> factor(identity + excess);
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  return windows * (moment.trace() - factor.solve(moment).trace() - log_determinant);
}

/// Most likely squared amplitudes, by the multiplicative form of Fisher scoring that keeps them
/// positive.
Spectrum Fitted(const Eigen::MatrixXd& moment, const std::array<Eigen::MatrixXd, 3>& patterns,
                double windows) {
  Spectrum spectrum;
  for (std::size_t j = 0; j < 3; ++j) {
    spectrum.squares[static_cast<Eigen::Index>(j)] =
        0.1 * moment.trace() / std::max(patterns[j].trace(), 1e-12);
  }
  const auto excess = [&] {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(moment.rows(), moment.rows());
    for (std::size_t j = 0; j < 3; ++j)
      sum += spectrum.squares[static_cast<Eigen::Index>(j)] * patterns[j];
    return sum;
  };
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::MatrixXd inverse =
        (Eigen::MatrixXd::Identity(moment.rows(), moment.rows()) + excess())
            .llt()
            .solve(Eigen::MatrixXd::Identity(moment.rows(), moment.rows()));
    const Eigen::MatrixXd seen = inverse * moment * inverse;
    for (std::size_t j = 0; j < 3; ++j) {
      const double wanted = (seen.array() * patterns[j].array()).sum();
      const double expected = (inverse.array() * patterns[j].array()).sum();
      spectrum.squares[static_cast<Eigen::Index>(j)] *=
          std::sqrt(wanted / std::max(expected, 1e-300));
    }
  }
  // What it explains of the mean square is no more than there is to explain.
  const double there = moment.trace() - static_cast<double>(moment.rows());
  const double explained = excess().trace();
  if (explained > there) spectrum.squares *= std::max(there, 0.0) / explained;
  spectrum.gain = GainOf(moment, excess(), windows);
  spectrum.explained = windows * excess().trace();
  return spectrum;
}

}  // namespace

EffectFit FitShaking(const Effect& effect, const FreeRuns& runs, const Healthy& healthy,
                     const Judge& judge, const Eigen::MatrixXd& errors, std::size_t threads) {
  const auto parameters = effect.Parameters();
  Require(parameters.size() == 4, "three amplitudes and a frequency");
  const Eigen::Index rows = runs.Rows();
  const auto windows = static_cast<Eigen::Index>(judge.Windows().size());
  const Eigen::MatrixXd moment = judge.MomentOfUnexplained(judge.See(errors));
  const double counted = judge.Kappa() * static_cast<double>(windows);

  std::array<double, kFrequencies> frequencies{};
  for (std::size_t i = 0; i < kFrequencies; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kFrequencies - 1);
    frequencies[i] =
        parameters[3].lower * std::pow(parameters[3].upper / parameters[3].lower, share);
  }
  std::array<Spectrum, kFrequencies> spectra;
  std::array<double, kFrequencies> usual{};  // gain on a healthy day
  ForEachIndex(kFrequencies, threads, [&](std::size_t i) {
    std::array<Eigen::MatrixXd, 3> patterns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      patterns[axis] = judge.Whiten(PatternOf(runs, healthy.boat, errors, axis, frequencies[i]));
    }
    spectra[i] = Fitted(moment, patterns, counted);
    for (const Eigen::MatrixXd& day : healthy.shaken) {
      usual[i] = std::max(usual[i], Fitted(day, patterns, counted).gain);
    }
  });
  const auto best = std::max_element(spectra.begin(), spectra.end(),
                                     [](const auto& a, const auto& b) { return a.gain < b.gain; });
  const double frequency = frequencies[static_cast<std::size_t>(best - spectra.begin())];

  EffectFit fit;
  ModelledEffect& modelled = fit.effects.emplace_back(ModelledEffect{&effect, {}});
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto& parameter = parameters[static_cast<std::size_t>(j)];
    modelled.values.push_back(
        std::clamp(std::sqrt(best->squares[j]), parameter.lower, parameter.upper));
  }
  modelled.values.push_back(frequency);
  // A fifth of each is what a recording of a hundred windows leaves open.
  fit.covariance = Eigen::MatrixXd::Zero(4, 4);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const double spread = modelled.values[static_cast<std::size_t>(j)] * std::sqrt(1.0 / counted);
    fit.covariance(j, j) = spread * spread;
  }
  const double swollen = moment.trace() / static_cast<double>(rows) - 1.0;
  const double alike =
      swollen > 0.0 ? GainOf(moment, swollen * Eigen::MatrixXd::Identity(rows, rows), counted)
                    : 0.0;
  const double cost = 4.0 * std::log(std::max(counted, 2.0));
  const double null_square = judge.Square(judge.See(errors));
  const double healthy_gain =
      kNeverInHealth + kBeyondHealthy * *std::max_element(usual.begin(), usual.end());
  // By size alone, as in FitEffects: what is there to explain beyond a healthy boat's scatter.
  const double by_size = std::max(judge.PlainSquare(errors) - judge.PlainOfHealth(), 0.0);
  fit.score = cost + healthy_gain -
              std::min({best->gain, 3.0 * (best->gain - alike), kSizeCounts * by_size});
  fit.square = null_square - best->explained;
  fit.errors = errors;
  fit.slot_sigmas.assign(4, 0.0);
  return fit;
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
  Eigen::MatrixXd excess = Eigen::MatrixXd::Zero(runs.Rows(), runs.Rows());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double amplitude = parameters[axis].typical;
    excess += amplitude * amplitude *
              judge.Whiten(PatternOf(runs, boat, nominal, axis, parameters[3].usual));
  }
  const auto identity = Eigen::MatrixXd::Identity(runs.Rows(), runs.Rows());
  const double windows = judge.Kappa() * static_cast<double>(judge.Windows().size());
  return std::sqrt(std::max(GainOf(identity + excess, excess, windows), 0.0));
}

}  // namespace telltale
