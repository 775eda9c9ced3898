#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"
#include "telltale/core/diagnosis/hypotheses/levenberg_marquardt.hpp"
#include "telltale/core/diagnosis/hypotheses/variation.hpp"

namespace telltale {
namespace {

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

EffectFit FitByMetric(const ErrorModel& error_model, const ResidualMetric& metric, double none,
                      const EffectParameters& parameters,
                      const std::vector<Eigen::VectorXd>& starts) {
  const EffectPosterior posterior(error_model, metric, parameters);
  return FitOfMinimum(LowestFrom(starts, posterior), posterior, none);
}

/// What acts for a share p of the time and scatters by s acts by s sqrt(p / (1 - p)) on average, on
/// its side: by so much at least, and no more than for half of the time.
void BoundMean(const ModelledEffect& intermittent, double sd, EffectParameters& parameters) {
  const EffectParameter& mean = intermittent.effect->Parameters().front();
  const double least = kDiagnosis.variation.least_mean * sd;
  const double most = kDiagnosis.variation.most_mean * sd;
  if (intermittent.values.front() < 0.0) {
    parameters.Bound(*intermittent.effect, std::max(mean.lower, -most), -least);
  } else {
    parameters.Bound(*intermittent.effect, least, std::min(mean.upper, most));
  }
}

/// The fit once more, allowing for the gusts, drifts and spells that the values of `about` stand
/// for. Nothing where nothing varies.
std::optional<EffectFit> WithVariationOf(const EffectFit& about, const EffectFit& fit,
                                         double intermittent_sd, const ErrorModel& error_model,
                                         const ResidualMetric& metric, double none) {
  ErrorVariation variation = VariationOf(about.effects, intermittent_sd, about.errors, error_model,
                                         kDiagnosis.horizons.main_s);
  if (variation.IsEmpty()) return std::nullopt;
  const ResidualMetric widened = metric.WithVariation(variation);
  EffectParameters parameters(about.Effects());
  for (const ModelledEffect& modelled : about.effects) {
    if (modelled.effect->IsIntermittent()) BoundMean(modelled, intermittent_sd, parameters);
  }
  EffectFit varying = FitByMetric(error_model, widened, none, parameters, {fit.Values()});
  varying.variation = std::move(variation);
  varying.intermittent_sd = intermittent_sd;
  varying.score += widened.VariationPenalty() - metric.VariationPenalty() +
                   ScatterDeficit(varying.variation, varying.errors, metric);
  return varying;
}

/// Fits of effects of which one acts at times only.
class IntermittentFits {
 public:
  IntermittentFits(const Effect& intermittent, const ErrorModel& error_model,
                   const ResidualMetric& metric, double none)
      : intermittent_(intermittent), error_model_(error_model), metric_(metric), none_(none) {}

  /// Of the likeliest side, and of the likeliest scatter there. The scatter is a parameter more.
  EffectFit Likeliest(const EffectFit& steady) const {
    const std::vector<double>& sds = intermittent_.Facts().intermittent_sds;
    const double middle = MiddleScatterOf(intermittent_);
    EffectFit fit = Fit(steady, -1.0, middle);
    TakeLikelier(Fit(steady, 1.0, middle), fit);
    const double side = SideOf(fit);
    for (const double sd : sds) {
      if (sd != middle) TakeLikelier(Fit(steady, side, sd), fit);
    }
    // Once more about the other effects as the spells leave them.
    if (fit.effects.size() > 1) fit = Fit(fit, side, fit.intermittent_sd);
    fit.score += metric_.ParameterPenalty();
    // A scatter without a mean is that of another effect.
    if (!TellsMean(fit)) fit.score = std::max(fit.score, 0.0);
    return fit;
  }

 private:
  /// Whether the errors tell more of the mean than its prior does, beside the other effects.
  bool TellsMean(const EffectFit& fit) const {
    const EffectParameters parameters(fit.Effects());
    const Eigen::Index mean = parameters.FirstOf(intermittent_);
    const double typical = parameters.TypicalSizes()[mean];
    const double scaled_variance = fit.covariance(mean, mean) / (typical * typical);
    return scaled_variance * parameters.PriorInformation()[mean] < 0.5;
  }

  static void TakeLikelier(EffectFit&& other, EffectFit& fit) {
    if (other.score < fit.score) fit = std::move(other);
  }

  double SideOf(const EffectFit& fit) const {
    const auto own = std::ranges::find(fit.effects, &intermittent_, &ModelledEffect::effect);
    return std::copysign(1.0, own->values.front());
  }

  /// From `fit`, on one side of zero. Spells are those about halfway to the bound: there they
  /// neither vanish nor pass it.
  EffectFit Fit(const EffectFit& fit, double side, double sd) const {
    EffectFit halfway = fit;
    const auto own = std::ranges::find(halfway.effects, &intermittent_, &ModelledEffect::effect);
    own->values.front() = side * 0.5 * intermittent_.Parameters().front().upper;
    halfway.errors = error_model_(halfway.effects);
    return WithVariationOf(halfway, fit, sd, error_model_, metric_, none_).value();
  }

  const Effect& intermittent_;
  const ErrorModel& error_model_;
  const ResidualMetric& metric_;
  double none_;
};

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
  return variation.IsEmpty() ? scattered : scattered.WithVariation(variation);
}

ErrorModel ErrorModelOf(const FreeRuns& runs, const AugmentedModel& boat) {
  return
      [&](const std::vector<ModelledEffect>& effects) { return runs.Errors(boat.With(effects)); };
}

EffectFit FitEffects(const ErrorModel& error_model, const ResidualMetric& metric,
                     const std::vector<const Effect*>& effects,
                     const std::vector<Eigen::VectorXd>& starts) {
  const double none = metric.SquaredMahalanobis(metric.Whiten(error_model({})));
  EffectFit steady = FitByMetric(error_model, metric, none, EffectParameters(effects), starts);
  const auto intermittent = std::ranges::find_if(effects, &Effect::IsIntermittent);
  if (intermittent != effects.end())
    return IntermittentFits(**intermittent, error_model, metric, none).Likeliest(steady);
  std::optional<EffectFit> varying =
      WithVariationOf(steady, steady, 0.0, error_model, metric, none);
  return varying && varying->score < steady.score ? *std::move(varying) : steady;
}

}  // namespace telltale
