#include "telltale/core/diagnosis/effect_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"

namespace telltale {
namespace {

constexpr double kPriorWidth = 2.0;   // of typical sizes
constexpr double kDerivative = 0.05;  // step in scaled values
constexpr int kMostIterations = 12;
constexpr double kConverged = 0.01;  // of -2 ln evidence
constexpr double kGiveUpDamping = 1e4;
constexpr double kLeastLeft = 1e-3;  // of a square, by a guess that promises more than there is

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
    for (Eigen::Index i = 0; i < Size(); ++i) scaled[i] = (values[i] - At(i).usual) / At(i).typical;
    return Clamped(scaled);
  }

  Eigen::VectorXd Clamped(Eigen::VectorXd scaled) const {
    for (Eigen::Index i = 0; i < Size(); ++i) {
      scaled[i] = std::clamp(scaled[i], (At(i).lower - At(i).usual) / At(i).typical,
                             (At(i).upper - At(i).usual) / At(i).typical);
    }
    return scaled;
  }

  std::vector<ModelledEffect> Effects(const Eigen::VectorXd& scaled) const {
    std::vector<ModelledEffect> modelled;
    Eigen::Index i = 0;
    for (const Effect* effect : effects_) {
      ModelledEffect& one = modelled.emplace_back(ModelledEffect{effect, {}});
      for (std::size_t j = 0; j < effect->Parameters().size(); ++j, ++i) {
        one.values.push_back(At(i).usual + At(i).typical * scaled[i]);
      }
    }
    return modelled;
  }

  Eigen::VectorXd PriorInformation() const {
    Eigen::VectorXd information(Size());
    for (Eigen::Index i = 0; i < Size(); ++i) {
      information[i] = At(i).shapes ? 1.0 : 1.0 / (kPriorWidth * kPriorWidth);
    }
    return information;
  }

  /// Away from the nearer bound.
  double DerivativeStep(Eigen::Index i, double scaled) const {
    const double upper = (At(i).upper - At(i).usual) / At(i).typical;
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

class Fitting {
 public:
  Fitting(const FreeRuns& runs, const AugmentedModel& boat, const Judge& judge,
          const Unknowns& unknowns)
      : runs_(runs), boat_(boat), judge_(judge), unknowns_(unknowns) {}

  Point At(const Eigen::VectorXd& scaled) const {
    Point point;
    point.scaled = scaled;
    point.errors = runs_.Errors(boat_.With(unknowns_.Effects(scaled)));
    point.seen = judge_.See(point.errors);
    point.square = judge_.Square(point.seen);
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
          (judge_.See(runs_.Errors(boat_.With(unknowns_.Effects(moved)))) - point.seen) / step;
    }
    return jacobian;
  }

  Point Descend(Point point) const {
    double damping = 1e-3;
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
      const Eigen::MatrixXd jacobian = Jacobian(point);
      const Eigen::MatrixXd weighed = judge_.Weigh(jacobian);
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
  const Judge& judge_;
  const Unknowns& unknowns_;
};

/// As FitEffects, but nothing gusts; `none` is the square that no effect at all leaves.
EffectFit FitSteady(const FreeRuns& runs, const AugmentedModel& boat, const Judge& judge,
                    double none, const std::vector<const Effect*>& effects,
                    const std::vector<Eigen::VectorXd>& starts) {
  const Unknowns unknowns(effects);
  const Fitting fitting(runs, boat, judge, unknowns);
  std::optional<Point> best;
  for (const Eigen::VectorXd& start : starts) {
    const Point found = fitting.Descend(fitting.At(unknowns.Scaled(start)));
    if (!best || found.cost < best->cost) best = found;
  }
  const Eigen::MatrixXd jacobian = fitting.Jacobian(*best);
  const Eigen::VectorXd prior = unknowns.PriorInformation();
  // Curvature of looks ln(square).
  const Eigen::MatrixXd seen = jacobian.transpose() * judge.Weigh(jacobian);
  Eigen::MatrixXd information = judge.Looks() / best->square * seen;
  information.diagonal() += prior;
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const double log_determinant =
      2.0 * factor.matrixLLT().diagonal().array().log().sum() - prior.array().log().sum();

  EffectFit fit;
  fit.effects = unknowns.Effects(best->scaled);
  fit.covariance = Scaled(Inverse(information), unknowns.Sizes());
  fit.square = best->square;
  fit.score = judge.Evidence(best->square, none) + best->cost - best->square + log_determinant;
  fit.errors = best->errors;
  return fit;
}

/// Length of those values that do not shape what others do.
double LengthOf(const ModelledEffect& modelled) {
  double squared = 0.0;
  for (std::size_t j = 0; j < modelled.values.size(); ++j) {
    const double value = modelled.values[j];
    if (!modelled.effect->Parameters()[j].shapes) squared += value * value;
  }
  return std::sqrt(squared);
}

/// What gusts about the effects' means do to errors: one column a parameter that gusts, for one
/// standard deviation of it.
Eigen::MatrixXd GustsOf(const EffectFit& fit, const FreeRuns& runs, const AugmentedModel& boat) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t i = 0; i < fit.effects.size(); ++i) {
    const Effect& effect = *fit.effects[i].effect;
    const double deviation = effect.Facts().gustiness * LengthOf(fit.effects[i]);
    if (deviation == 0.0) continue;
    for (std::size_t j = 0; j < effect.Parameters().size(); ++j) {
      if (effect.Parameters()[j].shapes) continue;
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

LinearGuess GuessOf(const Effect& effect, const Judge& judge, const Eigen::MatrixXd& errors,
                    const Sensitivity& recording, const std::vector<Slot>& slots) {
  LinearGuess guess;
  for (std::size_t j = 0; j < slots.size(); ++j) {
    if (slots[j].effect == &effect) guess.own.push_back(static_cast<Eigen::Index>(j));
  }
  const Eigen::MatrixXd seen = judge.SeeColumns(recording.by_slot(Eigen::all, guess.own));
  const Eigen::MatrixXd weighed = judge.Weigh(seen);
  const Eigen::VectorXd slope = weighed.transpose() * judge.See(errors);
  Eigen::MatrixXd information = seen.transpose() * weighed;
  information.diagonal().array() += 1.0 / (kPriorWidth * kPriorWidth);
  guess.sizes = -information.ldlt().solve(slope);
  for (std::size_t k = 0; k < guess.own.size(); ++k) {
    const Slot& slot = slots[static_cast<std::size_t>(guess.own[k])];
    const EffectParameter& parameter = effect.Parameters()[slot.parameter];
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

double EffectFit::Strain() const {
  double squares = 0.0;
  for (const ModelledEffect& modelled : effects) {
    const auto& parameters = modelled.effect->Parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (!parameters[i].shapes) continue;
      const double off = (modelled.values[i] - parameters[i].usual) / parameters[i].typical;
      squares += off * off;
    }
  }
  return 0.5 * squares;
}

Judge EffectFit::JudgedBy(const Judge& judge) const {
  return gusts.size() == 0 ? judge : judge.Allowing(gusts);
}

EffectFit FitEffects(const FreeRuns& runs, const AugmentedModel& boat, const Judge& judge,
                     const std::vector<const Effect*>& effects,
                     const std::vector<Eigen::VectorXd>& starts) {
  const double none = judge.Square(judge.See(runs.Errors(boat)));
  EffectFit steady = FitSteady(runs, boat, judge, none, effects, starts);
  const Eigen::MatrixXd gusts = GustsOf(steady, runs, boat);
  if (gusts.size() == 0) return steady;
  const Judge allowing = judge.Allowing(gusts);
  EffectFit gusty = FitSteady(runs, boat, allowing, none, effects, {steady.Values()});
  gusty.gusts = gusts;
  gusty.score += allowing.Allowance();
  return gusty.score < steady.score ? gusty : steady;
}

std::vector<Eigen::VectorXd> StartsOf(const Effect& effect, const Judge& judge,
                                      const Eigen::MatrixXd& errors, const Sensitivity& recording,
                                      const std::vector<Slot>& slots) {
  const LinearGuess guess = GuessOf(effect, judge, errors, recording, slots);
  Eigen::VectorXd usual(static_cast<Eigen::Index>(effect.Parameters().size()));
  for (Eigen::Index i = 0; i < usual.size(); ++i) {
    usual[i] = effect.Parameters()[static_cast<std::size_t>(i)].usual;
  }
  std::vector<Eigen::VectorXd> starts = {usual};
  for (std::size_t k = 0; k < guess.own.size(); ++k) {
    const Slot& slot = slots[static_cast<std::size_t>(guess.own[k])];
    starts[0][static_cast<Eigen::Index>(slot.parameter)] =
        effect.Parameters()[slot.parameter].typical * guess.sizes[static_cast<Eigen::Index>(k)];
  }
  if (guess.own.size() != 1) return starts;
  const Slot& slot = slots[static_cast<std::size_t>(guess.own[0])];
  const EffectParameter& parameter = effect.Parameters()[slot.parameter];
  for (const double size : {parameter.typical, -parameter.typical}) {
    if (size < parameter.lower || size > parameter.upper) continue;
    Eigen::VectorXd start = usual;
    start[static_cast<Eigen::Index>(slot.parameter)] = size;
    starts.push_back(start);
  }
  return starts;
}

double ScoreTest(const Effect& effect, const Judge& judge, const Eigen::MatrixXd& errors,
                 const Sensitivity& recording, const std::vector<Slot>& slots) {
  const double none = judge.Square(judge.See(errors));
  const double promise = GuessOf(effect, judge, errors, recording, slots).promise;
  return judge.Evidence(std::clamp(none - promise, kLeastLeft * none, none), none);
}

}  // namespace telltale
