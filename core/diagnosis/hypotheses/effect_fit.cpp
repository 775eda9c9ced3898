#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"
#include "telltale/core/diagnosis/hypotheses/levenberg_marquardt.hpp"

namespace telltale {
namespace {

constexpr double kInvisible = 1e-12;
constexpr double kLeastScatter = 1e-4;  // of the variance that an intermittent effect stands for

PosteriorPoint LowestFrom(const std::vector<Eigen::VectorXd>& starts,
                          const EffectPosterior& posterior) {
  std::optional<PosteriorPoint> best;
  for (const Eigen::VectorXd& start : starts) {
    const PosteriorPoint found =
        MinimiseCost(posterior, posterior.At(posterior.Parameters().Scaled(start)));
    if (!best || found.cost < best->cost) best = found;
  }
  return *best;
}

/// Laplace's evidence and the covariance at the minimum. `none` is the square without any effect.
EffectFit FitOfMinimum(const PosteriorPoint& minimum, const EffectPosterior& posterior,
                       double none) {
  const ResidualMetric& metric = posterior.Metric();
  const EffectParameters& parameters = posterior.Parameters();
  const Eigen::MatrixXd jacobian = posterior.Jacobian(minimum);
  const Eigen::VectorXd prior = parameters.PriorInformation();
  // The curvature of n ln(square), n the effective number of observations.
  const Eigen::MatrixXd curvature = jacobian.transpose() * metric.Marginalise(jacobian);
  Eigen::MatrixXd information = metric.EffectiveObservations() / minimum.square * curvature;
  information.diagonal() += prior;
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const double log_determinant =
      2.0 * factor.matrixLLT().diagonal().array().log().sum() - prior.array().log().sum();

  EffectFit fit;
  fit.effects = parameters.Effects(minimum.scaled);
  fit.covariance = Scaled(Inverse(information), parameters.TypicalSizes());
  fit.square = minimum.square;
  fit.score =
      metric.Deviance(minimum.square, none) + minimum.cost - minimum.square + log_determinant;
  fit.errors = minimum.errors;
  return fit;
}

EffectFit FitWithoutGusts(const ErrorModel& error_model, const ResidualMetric& metric, double none,
                          const std::vector<const Effect*>& effects,
                          const std::vector<Eigen::VectorXd>& starts) {
  const EffectParameters parameters(effects);
  const EffectPosterior posterior(error_model, metric, parameters);
  return FitOfMinimum(LowestFrom(starts, posterior), posterior, none);
}

/// Length of the vector of those values that are not shape parameters.
double LengthOf(const ModelledEffect& modelled) {
  double squared = 0.0;
  for (std::size_t j = 0; j < modelled.values.size(); ++j) {
    const double value = modelled.values[j];
    if (!modelled.effect->Parameters()[j].is_shape) squared += value * value;
  }
  return std::sqrt(squared);
}

/// One standard deviation of what gusts: the turbulence intensity times the length of the mean.
double DeviationOf(const ModelledEffect& modelled) {
  return modelled.effect->Facts().turbulence_intensity * LengthOf(modelled);
}

/// EffectFit::gusts of a fit: secants over one standard deviation.
Eigen::MatrixXd GustsOf(const EffectFit& fit, const ErrorModel& error_model) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t i = 0; i < fit.effects.size(); ++i) {
    const Effect& effect = *fit.effects[i].effect;
    const double deviation = DeviationOf(fit.effects[i]);
    if (deviation == 0.0) continue;
    for (std::size_t j = 0; j < effect.Parameters().size(); ++j) {
      if (effect.Parameters()[j].is_shape) continue;
      auto gusting = fit.effects;
      gusting[i].values[j] += deviation;
      columns.emplace_back((error_model(gusting) - fit.errors).reshaped());
    }
  }
  Eigen::MatrixXd gusts(fit.errors.size(), std::ssize(columns));
  for (Eigen::Index j = 0; j < gusts.cols(); ++j) {
    gusts.col(j) = columns[static_cast<std::size_t>(j)];
  }
  return gusts;
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
      const auto by_window = whitened.col(column++).reshaped(left.rows(), left.cols());
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

double EffectFit::NegativeLogPrior() const {
  double squares = 0.0;
  for (const ModelledEffect& modelled : effects) {
    const auto& parameters = modelled.effect->Parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (!parameters[i].is_shape) continue;
      const double off = (modelled.values[i] - parameters[i].prior_mean) / parameters[i].typical;
      squares += off * off;
    }
  }
  return 0.5 * squares;
}

ResidualMetric EffectFit::WidenedMetric(const ResidualMetric& metric) const {
  return gusts.size() == 0 ? metric : metric.WithWindowVariation(gusts);
}

ErrorModel ErrorModelOf(const FreeRuns& runs, const AugmentedModel& boat) {
  return
      [&](const std::vector<ModelledEffect>& effects) { return runs.Errors(boat.With(effects)); };
}

EffectFit FitEffects(const ErrorModel& error_model, const ResidualMetric& metric,
                     const std::vector<const Effect*>& effects,
                     const std::vector<Eigen::VectorXd>& starts) {
  const double none = metric.SquaredMahalanobis(metric.Whiten(error_model({})));
  EffectFit steady = FitWithoutGusts(error_model, metric, none, effects, starts);
  const Eigen::MatrixXd gusts = GustsOf(steady, error_model);
  if (gusts.size() == 0) return steady;
  const ResidualMetric widened = metric.WithWindowVariation(gusts);
  EffectFit gusty = FitWithoutGusts(error_model, widened, none, effects, {steady.Values()});
  gusty.gusts = gusts;
  gusty.score += widened.VariationPenalty() + ScatterDeficit(steady, gusty, metric);
  const bool is_intermittent =
      std::any_of(effects.begin(), effects.end(),
                  [](const Effect* effect) { return effect->Facts().is_intermittent; });
  return is_intermittent || gusty.score < steady.score ? gusty : steady;
}

}  // namespace telltale
