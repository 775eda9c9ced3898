#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

constexpr double kPriorWidth = 2.0;   // of typical sizes
constexpr double kDerivative = 0.05;  // step in scaled values
constexpr int kMaximumIterations = 12;
constexpr double kConverged = 0.01;  // of -2 ln evidence
constexpr double kGiveUpDamping = 1e4;
constexpr double kMinimumRemainingShare =
    1e-3;  // of a square, by a guess that promises more than there is

/// The stacked values of effects, scaled so that priors are of order one and bounds are known.
class Unknowns {
 public:
  explicit Unknowns(const std::vector<const Effect*>& effects) : effects_(effects) {
    for (const Effect* effect : effects) {
      for (const EffectParameter& parameter : effect->Parameters())
        parameters_.push_back(&parameter);
    }
  }

  Eigen::Index Size() const { return static_cast<Eigen::Index>(parameters_.size()); }

  Eigen::VectorXd Scaled(const Eigen::VectorXd& values) const {
    Eigen::VectorXd scaled(Size());
    for (Eigen::Index i = 0; i < Size(); ++i)
      scaled[i] = (values[i] - At(i).prior_mean) / At(i).typical;
    return Clamped(scaled);
  }

  Eigen::VectorXd Clamped(Eigen::VectorXd scaled) const {
    for (Eigen::Index i = 0; i < Size(); ++i) {
      scaled[i] = std::clamp(scaled[i], (At(i).lower - At(i).prior_mean) / At(i).typical,
                             (At(i).upper - At(i).prior_mean) / At(i).typical);
    }
    return scaled;
  }

  std::vector<ModelledEffect> Effects(const Eigen::VectorXd& scaled) const {
    std::vector<ModelledEffect> modelled;
    Eigen::Index i = 0;
    for (const Effect* effect : effects_) {
      ModelledEffect& one = modelled.emplace_back(ModelledEffect{effect, {}});
      for (std::size_t j = 0; j < effect->Parameters().size(); ++j, ++i) {
        one.values.push_back(At(i).prior_mean + At(i).typical * scaled[i]);
      }
    }
    return modelled;
  }

  Eigen::VectorXd PriorInformation() const {
    Eigen::VectorXd information(Size());
    for (Eigen::Index i = 0; i < Size(); ++i) {
      information[i] = At(i).is_shape ? 1.0 : 1.0 / (kPriorWidth * kPriorWidth);
    }
    return information;
  }

  /// Away from the nearer bound.
  double DerivativeStep(Eigen::Index i, double scaled) const {
    const double upper = (At(i).upper - At(i).prior_mean) / At(i).typical;
    return scaled + kDerivative > upper ? -kDerivative : kDerivative;
  }

  Eigen::VectorXd Sizes() const {
    Eigen::VectorXd sizes(Size());
    for (Eigen::Index i = 0; i < Size(); ++i) sizes[i] = At(i).typical;
    return sizes;
  }

 private:
  const EffectParameter& At(Eigen::Index i) const {
    return *parameters_[static_cast<std::size_t>(i)];
  }

  std::vector<const Effect*> effects_;
  std::vector<const EffectParameter*> parameters_;
};

struct Point {
  Eigen::VectorXd scaled;
  Eigen::MatrixXd errors;
  Eigen::VectorXd seen;
  double square = 0.0;
  double cost = 0.0;
};

class EffectFitting {
 public:
  EffectFitting(const FreeRuns& runs, const AugmentedModel& boat, const ResidualMetric& metric,
                const Unknowns& unknowns)
      : runs_(runs), boat_(boat), metric_(metric), unknowns_(unknowns) {}

  Point At(const Eigen::VectorXd& scaled) const {
    Point point;
    point.scaled = scaled;
    point.errors = runs_.Errors(boat_.With(unknowns_.Effects(scaled)));
    point.seen = metric_.Whiten(point.errors);
    point.square = metric_.SquaredMahalanobis(point.seen);
    point.cost = point.square + scaled.cwiseAbs2().dot(unknowns_.PriorInformation());
    return point;
  }

  Eigen::MatrixXd Jacobian(const Point& point) const {
    Eigen::MatrixXd jacobian(point.seen.size(), unknowns_.Size());
    for (Eigen::Index i = 0; i < unknowns_.Size(); ++i) {
      const double step = unknowns_.DerivativeStep(i, point.scaled[i]);
      Eigen::VectorXd moved = point.scaled;
      moved[i] += step;
      jacobian.col(i) =
          (metric_.Whiten(runs_.Errors(boat_.With(unknowns_.Effects(moved)))) - point.seen) / step;
    }
    return jacobian;
  }

  Point Descend(Point point) const {
    double damping = 1e-3;
    for (int iteration = 0; iteration < kMaximumIterations; ++iteration) {
      const Eigen::MatrixXd jacobian = Jacobian(point);
      const Eigen::MatrixXd weighed = metric_.Marginalise(jacobian);
      const Eigen::VectorXd prior = unknowns_.PriorInformation();
      Eigen::MatrixXd information = jacobian.transpose() * weighed;
      information.diagonal() += prior;
      const Eigen::VectorXd slope =
          weighed.transpose() * point.seen + prior.cwiseProduct(point.scaled);
      double gained = 0.0;
      while (damping < kGiveUpDamping) {
        Eigen::MatrixXd damped = information;
        damped.diagonal() *= 1.0 + damping;
        const Point next = At(unknowns_.Clamped(point.scaled - damped.ldlt().solve(slope)));
        if (next.cost < point.cost) {
          gained = point.cost - next.cost;
          point = next;
          damping = std::max(damping / 10.0, 1e-6);
          break;
        }
        damping *= 10.0;
      }
      if (gained < kConverged) break;
    }
    return point;
  }

 private:
  const FreeRuns& runs_;
  const AugmentedModel& boat_;
  const ResidualMetric& metric_;
  const Unknowns& unknowns_;
};

/// As FitEffects, but nothing gusts; `none` is the square that no effect at all leaves.
EffectFit FitWithoutGusts(const FreeRuns& runs, const AugmentedModel& boat,
                          const ResidualMetric& metric, double none,
                          const std::vector<const Effect*>& effects,
                          const std::vector<Eigen::VectorXd>& starts) {
  const Unknowns unknowns(effects);
  const EffectFitting fitting(runs, boat, metric, unknowns);
  std::optional<Point> best;
  for (const Eigen::VectorXd& start : starts) {
    const Point found = fitting.Descend(fitting.At(unknowns.Scaled(start)));
    if (!best || found.cost < best->cost) best = found;
  }
  const Eigen::MatrixXd jacobian = fitting.Jacobian(*best);
  const Eigen::VectorXd prior = unknowns.PriorInformation();
  // Curvature of looks ln(square).
  const Eigen::MatrixXd seen = jacobian.transpose() * metric.Marginalise(jacobian);
  Eigen::MatrixXd information = metric.EffectiveObservations() / best->square * seen;
  information.diagonal() += prior;
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const double log_determinant =
      2.0 * factor.matrixLLT().diagonal().array().log().sum() - prior.array().log().sum();

  EffectFit fit;
  fit.effects = unknowns.Effects(best->scaled);
  fit.covariance = Scaled(Inverse(information), unknowns.Sizes());
  fit.square = best->square;
  fit.score = metric.Deviance(best->square, none) + best->cost - best->square + log_determinant;
  fit.errors = best->errors;
  return fit;
}

/// Length of those values that do not shape what others do.
double LengthOf(const ModelledEffect& modelled) {
  double squared = 0.0;
  for (std::size_t j = 0; j < modelled.values.size(); ++j) {
    const double value = modelled.values[j];
    if (!modelled.effect->Parameters()[j].is_shape) squared += value * value;
  }
  return std::sqrt(squared);
}

/// What gusts about the effects' means do to errors: one column a parameter that gusts, for one
/// standard deviation of it.
Eigen::MatrixXd GustsOf(const EffectFit& fit, const FreeRuns& runs, const AugmentedModel& boat) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t i = 0; i < fit.effects.size(); ++i) {
    const Effect& effect = *fit.effects[i].effect;
    const double deviation = effect.Facts().turbulence_intensity * LengthOf(fit.effects[i]);
    if (deviation == 0.0) continue;
    for (std::size_t j = 0; j < effect.Parameters().size(); ++j) {
      if (effect.Parameters()[j].is_shape) continue;
      auto gusting = fit.effects;
      gusting[i].values[j] += deviation;
      columns.emplace_back((runs.Errors(boat.With(gusting)) - fit.errors).reshaped());
    }
  }
  Eigen::MatrixXd gusts(fit.errors.size(), std::ssize(columns));
  for (Eigen::Index j = 0; j < gusts.cols(); ++j) {
    gusts.col(j) = columns[static_cast<std::size_t>(j)];
  }
  return gusts;
}

/// What a step along an effect's slots, from none of it, promises.
struct LinearGuess {
  std::vector<Eigen::Index> own;  ///< its slots
  Eigen::VectorXd sizes;          ///< in typical sizes, within the range
  double promise = 0.0;
};

LinearGuess GuessOf(const Effect& effect, const ResidualMetric& metric,
                    const Eigen::MatrixXd& errors, const Sensitivity& recording,
                    const std::vector<EffectParameterRef>& parameter_refs) {
  LinearGuess guess;
  for (std::size_t j = 0; j < parameter_refs.size(); ++j) {
    if (parameter_refs[j].effect == &effect) guess.own.push_back(static_cast<Eigen::Index>(j));
  }
  const Eigen::MatrixXd seen =
      metric.WhitenColumns(recording.by_effect_parameter(Eigen::all, guess.own));
  const Eigen::MatrixXd weighed = metric.Marginalise(seen);
  const Eigen::VectorXd slope = weighed.transpose() * metric.Whiten(errors);
  Eigen::MatrixXd information = seen.transpose() * weighed;
  information.diagonal().array() += 1.0 / (kPriorWidth * kPriorWidth);
  guess.sizes = -information.ldlt().solve(slope);
  for (std::size_t k = 0; k < guess.own.size(); ++k) {
    const EffectParameterRef& parameter_ref =
        parameter_refs[static_cast<std::size_t>(guess.own[k])];
    const EffectParameter& parameter = effect.Parameters()[parameter_ref.parameter];
    double& size = guess.sizes[static_cast<Eigen::Index>(k)];
    size =
        std::clamp(size, parameter.lower / parameter.typical, parameter.upper / parameter.typical);
  }
  guess.promise = -2.0 * slope.dot(guess.sizes) - guess.sizes.dot(information * guess.sizes);
  return guess;
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

EffectFit FitEffects(const FreeRuns& runs, const AugmentedModel& boat, const ResidualMetric& metric,
                     const std::vector<const Effect*>& effects,
                     const std::vector<Eigen::VectorXd>& starts) {
  const double none = metric.SquaredMahalanobis(metric.Whiten(runs.Errors(boat)));
  EffectFit steady = FitWithoutGusts(runs, boat, metric, none, effects, starts);
  const Eigen::MatrixXd gusts = GustsOf(steady, runs, boat);
  if (gusts.size() == 0) return steady;
  const ResidualMetric widened = metric.WithWindowVariation(gusts);
  EffectFit gusty = FitWithoutGusts(runs, boat, widened, none, effects, {steady.Values()});
  gusty.gusts = gusts;
  gusty.score += widened.VariationPenalty();
  return gusty.score < steady.score ? gusty : steady;
}

std::vector<Eigen::VectorXd> StartsOf(const Effect& effect, const ResidualMetric& metric,
                                      const Eigen::MatrixXd& errors, const Sensitivity& recording,
                                      const std::vector<EffectParameterRef>& parameter_refs) {
  const LinearGuess guess = GuessOf(effect, metric, errors, recording, parameter_refs);
  Eigen::VectorXd prior_mean(static_cast<Eigen::Index>(effect.Parameters().size()));
  for (Eigen::Index i = 0; i < prior_mean.size(); ++i) {
    prior_mean[i] = effect.Parameters()[static_cast<std::size_t>(i)].prior_mean;
  }
  std::vector<Eigen::VectorXd> starts = {prior_mean};
  for (std::size_t k = 0; k < guess.own.size(); ++k) {
    const EffectParameterRef& parameter_ref =
        parameter_refs[static_cast<std::size_t>(guess.own[k])];
    starts[0][static_cast<Eigen::Index>(parameter_ref.parameter)] =
        effect.Parameters()[parameter_ref.parameter].typical *
        guess.sizes[static_cast<Eigen::Index>(k)];
  }
  if (guess.own.size() != 1) return starts;
  const EffectParameterRef& parameter_ref = parameter_refs[static_cast<std::size_t>(guess.own[0])];
  const EffectParameter& parameter = effect.Parameters()[parameter_ref.parameter];
  for (const double size : {parameter.typical, -parameter.typical}) {
    if (size < parameter.lower || size > parameter.upper) continue;
    Eigen::VectorXd start = prior_mean;
    start[static_cast<Eigen::Index>(parameter_ref.parameter)] = size;
    starts.push_back(start);
  }
  return starts;
}

double ScoreTest(const Effect& effect, const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                 const Sensitivity& recording,
                 const std::vector<EffectParameterRef>& parameter_refs) {
  const double none = metric.SquaredMahalanobis(metric.Whiten(errors));
  const double promise = GuessOf(effect, metric, errors, recording, parameter_refs).promise;
  return metric.Deviance(std::clamp(none - promise, kMinimumRemainingShare * none, none), none);
}

}  // namespace telltale
