#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"
#include "telltale/core/diagnosis/hypotheses/levenberg_marquardt.hpp"
#include "telltale/core/effects/gust_pattern.hpp"

namespace telltale {
namespace {

constexpr double kInvisible = 1e-12;
constexpr int kRoundsOfScatter = 4;     // of an intermittent effect and its mean, in turn
constexpr double kSettled = 0.01;       // 1, change of all values in the last of them
constexpr double kLeastScatter = 1e-4;  // of the variance that an intermittent effect stands for

Minimum LowestFrom(const std::vector<Eigen::VectorXd>& starts, const EffectPosterior& posterior) {
  std::optional<Minimum> best;
  for (const Eigen::VectorXd& start : starts) {
    Minimum found = MinimiseCost(posterior, posterior.At(posterior.Parameters().Scaled(start)));
    if (!best || found.point.cost < best->point.cost) best = std::move(found);
  }
  return *std::move(best);
}

/// Laplace's evidence and the covariance at the minimum. `none` is the square without any effect.
EffectFit FitOfMinimum(const Minimum& minimum, const EffectPosterior& posterior, double none) {
  const ResidualMetric& metric = posterior.Metric();
  const EffectParameters& parameters = posterior.Parameters();
  const PosteriorPoint& point = minimum.point;
  const Eigen::MatrixXd information =
      posterior.Information(point, minimum.jacobian, minimum.marginalised);
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const double log_determinant =
      LogDeterminant(factor) - parameters.PriorInformation().array().log().sum();

  EffectFit fit;
  fit.effects = parameters.Effects(point.scaled);
  fit.covariance = Scaled(Inverse(information), parameters.TypicalSizes());
  fit.square = point.square;
  fit.score = point.cost - metric.Deviance(none, metric.ExpectedSquare()) + log_determinant;
  fit.errors = point.errors;
  return fit;
}

EffectFit FitWithoutGusts(const ErrorModel& error_model, const ResidualMetric& metric, double none,
                          const std::vector<const Effect*>& effects,
                          const std::vector<Eigen::VectorXd>& starts) {
  const EffectParameters parameters(effects);
  const EffectPosterior posterior(error_model, metric, parameters);
  return FitOfMinimum(LowestFrom(starts, posterior), posterior, none);
}

/// Those values that are not shape parameters.
std::vector<double> SizesOf(const ModelledEffect& modelled) {
  std::vector<double> sizes;
  for (std::size_t j = 0; j < modelled.values.size(); ++j) {
    if (!modelled.effect->Parameters()[j].is_shape) sizes.push_back(modelled.values[j]);
  }
  return sizes;
}

/// Length of the vector of sizes.
double LengthOf(const ModelledEffect& modelled) {
  double squared = 0.0;
  for (const double size : SizesOf(modelled)) squared += size * size;
  return std::sqrt(squared);
}

/// One standard deviation of what gusts: the turbulence intensity times the length of the mean.
double DeviationOf(const ModelledEffect& modelled) {
  return modelled.effect->Facts().turbulence_intensity * LengthOf(modelled);
}

/// One way in which a gust may run through a window, and its share of the gust's variance.
struct GustCourse {
  double frequency_rad_s = 0.0;  ///< 0: the same all along
  double phase_rad = 0.0;
  double share = 1.0;
};

/// The ways of an effect's gusts, the constant one first. The correlation exp(-t / T) of a
/// first-order process is, within a window of H, the sum over k of c_k cos(k pi t / H), with c_k =
/// 2 T/H (1 - (-1)^k exp(-H/T)) / (1 + (k pi T/H)^2) and half of that for k = 0: each term is a
/// cosine and a sine of independent random sizes. What oscillates faster than k = 1 hardly moves a
/// boat.
std::vector<GustCourse> CoursesOf(const EffectFacts& facts, double window_s) {
  if (facts.turbulence_time_s == 0.0) return {{}};
  constexpr double kHalfTurn = std::numbers::pi;
  const double lasting = facts.turbulence_time_s / window_s;
  const double kept = std::exp(-1.0 / lasting);
  const double oscillating =
      2.0 * lasting * (1.0 + kept) / (1.0 + kHalfTurn * kHalfTurn * lasting * lasting);
  const double frequency = kHalfTurn / window_s;
  return {{0.0, 0.0, lasting * (1.0 - kept)},
          {frequency, 0.0, oscillating},
          {frequency, -0.5 * kHalfTurn, oscillating}};
}

/// What a deviation of one parameter of one effect, along a course, does to the errors.
/// Oscillations are no larger than the effect itself, beyond which it may act on the other side,
/// and scaled to the deviation.
Eigen::MatrixXd EffectOfGust(const std::vector<ModelledEffect>& effects,
                             const Eigen::MatrixXd& errors, std::size_t gusting,
                             std::size_t parameter, double deviation, const GustCourse& course,
                             const ErrorModel& error_model) {
  auto changed = effects;
  if (course.frequency_rad_s == 0.0) {
    changed[gusting].values[parameter] += deviation;
    return error_model(changed) - errors;
  }
  const double amplitude = std::min(deviation, LengthOf(effects[gusting]));
  const GustPattern pattern(*effects[gusting].effect,
                            {parameter, amplitude, course.frequency_rad_s, course.phase_rad});
  changed[gusting].effect = &pattern;
  return deviation / amplitude * (error_model(changed) - errors);
}

/// By how much the scatter from window to window that the intermittent effects of a fit stand for
/// falls short, in -2 ln of the likelihood of so little: n (s - 1 - ln s) where the realised
/// variance s, over that of the gusts, which are those of `steady`, is below one.
double ScatterDeficit(const EffectFit& steady, const EffectFit& gusty,
                      const ResidualMetric& metric) {
  const Eigen::MatrixXd left = metric.UnexplainedByWindow(metric.Whiten(gusty.errors));
  const Eigen::MatrixXd whitened = metric.WhitenColumns(gusty.gusts) / std::sqrt(metric.Kappa());
  double deficit = 0.0;
  Eigen::Index column = 0;
  for (const ModelledEffect& modelled : steady.effects) {
    const EffectFacts& facts = modelled.effect->Facts();
    if (DeviationOf(modelled) == 0.0) continue;
    for (const EffectParameter& parameter : facts.parameters) {
      if (parameter.is_shape) continue;
      // What stays as it is throughout a window.
      const auto by_window = whitened.col(column).reshaped(left.rows(), left.cols());
      column += std::ssize(CoursesOf(facts, kDiagnosis.horizons.main_s));
      if (!facts.is_intermittent) continue;
      const Eigen::ArrayXd squares = by_window.colwise().squaredNorm().transpose().array();
      const Eigen::ArrayXd along = left.cwiseProduct(by_window).colwise().sum().transpose().array();
      // Each window's own noise adds one.
      const double realised = (along.square() / squares.max(kInvisible) - 1.0).sum();
      const double ratio = std::clamp(realised / squares.sum(), kLeastScatter, 1.0);
      deficit += metric.EffectiveObservations() * (ratio - 1.0 - std::log(ratio));
    }
  }
  return deficit;
}

/// The fit once more, allowing for the gusts that its values stand for. Nothing where nothing
/// gusts.
std::optional<EffectFit> WithGustsOf(const EffectFit& fit, const ErrorModel& error_model,
                                     const ResidualMetric& metric, double none) {
  const Eigen::MatrixXd gusts =
      GustsOf(fit.effects, fit.errors, error_model, kDiagnosis.horizons.main_s);
  if (gusts.size() == 0) return std::nullopt;
  const ResidualMetric widened = metric.WithWindowVariation(gusts);
  EffectFit gusty = FitWithoutGusts(error_model, widened, none, fit.Effects(), {fit.Values()});
  gusty.gusts = gusts;
  gusty.score +=
      widened.VariationPenalty() - metric.VariationPenalty() + ScatterDeficit(fit, gusty, metric);
  return gusty;
}

}  // namespace

std::vector<const Effect*> EffectFit::Effects() const {
  std::vector<const Effect*> all;
  for (const ModelledEffect& modelled : effects) all.push_back(modelled.effect);
  return all;
}

std::vector<std::string> EffectFit::Names() const {
  std::vector<std::string> names;
  for (const ModelledEffect& modelled : effects) names.emplace_back(modelled.effect->Name());
  return names;
}

Eigen::VectorXd EffectFit::Values() const {
  std::vector<double> values;
  for (const ModelledEffect& modelled : effects) {
    values.insert(values.end(), modelled.values.begin(), modelled.values.end());
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

EffectFit EffectFit::Deterministic() const {
  EffectFit fit;
  std::ranges::copy_if(effects, std::back_inserter(fit.effects),
                       [](const auto& modelled) { return !modelled.effect->IsStochastic(); });
  return fit;
}

const Effect* EffectFit::Stochastic() const {
  const Effect* last = effects.empty() ? nullptr : effects.back().effect;
  return last != nullptr && last->IsStochastic() ? last : nullptr;
}

std::size_t EffectFit::Faults() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      effects,
      [](const ModelledEffect& modelled) { return !modelled.effect->Facts().is_weather; }));
}

double EffectFit::NegativeLogPrior() const {
  double squares = 0.0;
  for (const ModelledEffect& modelled : Deterministic().effects) {
    const auto& parameters = modelled.effect->Parameters();
    if (modelled.effect->Facts().is_all_or_nothing) {
      const double off =
          (1.0 - std::ranges::max(SizesOf(modelled))) / kDiagnosis.effect_fit.whole_sd;
      squares += off * off;
    }
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (!parameters[i].is_shape) continue;
      const double off = (modelled.values[i] - parameters[i].prior_mean) / parameters[i].typical;
      squares += off * off;
    }
  }
  return 0.5 * squares;
}

ResidualMetric EffectFit::ScatteredMetric(const ResidualMetric& metric) const {
  return scatter.size() > 0 ? metric.WithWindowScatter(scatter) : metric;
}

ResidualMetric EffectFit::WidenedMetric(const ResidualMetric& metric) const {
  const ResidualMetric scattered = ScatteredMetric(metric);
  return gusts.size() == 0 ? scattered : scattered.WithWindowVariation(gusts);
}

ErrorModel ErrorModelOf(const FreeRuns& runs, const AugmentedModel& boat) {
  return
      [&](const std::vector<ModelledEffect>& effects) { return runs.Errors(boat.With(effects)); };
}

Eigen::MatrixXd GustsOf(const std::vector<ModelledEffect>& effects, const Eigen::MatrixXd& errors,
                        const ErrorModel& error_model, double window_s) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const Effect& effect = *effects[i].effect;
    const double deviation = DeviationOf(effects[i]);
    if (deviation == 0.0) continue;
    for (std::size_t j = 0; j < effect.Parameters().size(); ++j) {
      if (effect.Parameters()[j].is_shape) continue;
      for (const GustCourse& course : CoursesOf(effect.Facts(), window_s)) {
        const double size = deviation * std::sqrt(course.share);
        columns.emplace_back(
            EffectOfGust(effects, errors, i, j, size, course, error_model).reshaped());
      }
    }
  }
  Eigen::MatrixXd gusts(errors.size(), std::ssize(columns));
  for (Eigen::Index j = 0; j < gusts.cols(); ++j) {
    gusts.col(j) = columns[static_cast<std::size_t>(j)];
  }
  return gusts;
}

EffectFit FitEffects(const ErrorModel& error_model, const ResidualMetric& metric,
                     const std::vector<const Effect*>& effects,
                     const std::vector<Eigen::VectorXd>& starts) {
  const double none = metric.SquaredMahalanobis(metric.Whiten(error_model({})));
  EffectFit steady = FitWithoutGusts(error_model, metric, none, effects, starts);
  std::optional<EffectFit> gusty = WithGustsOf(steady, error_model, metric, none);
  if (!gusty) return steady;
  const bool is_intermittent =
      std::any_of(effects.begin(), effects.end(),
                  [](const Effect* effect) { return effect->Facts().is_intermittent; });
  if (!is_intermittent) return gusty->score < steady.score ? *std::move(gusty) : steady;
  // It scatters as its mean says, and its mean changes once its scatter is allowed for: in turn.
  EffectFit fit = *std::move(gusty);
  for (int round = 1; round < kRoundsOfScatter; ++round) {
    std::optional<EffectFit> next = WithGustsOf(fit, error_model, metric, none);
    if (!next) break;
    const Eigen::VectorXd before = fit.Values();
    fit = *std::move(next);
    if (fit.Values().isApprox(before, kSettled)) break;
  }
  // Its scatter is a parameter more.
  fit.score += metric.ParameterPenalty();
  return fit;
}

}  // namespace telltale
