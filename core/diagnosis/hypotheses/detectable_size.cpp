#include "telltale/core/diagnosis/hypotheses/detectable_size.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"
#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"

namespace telltale {
namespace {

constexpr double kWantedPower = kDiagnosis.testability.power;
// The distance that an effect moves errors grows with the square of its size as long as it acts
// linearly, so that few steps do.
constexpr int kSizeSteps = 8;
constexpr double kSizeTolerance = 0.01;

/// How one parameter of an effect moves the errors of the nominal boat.
class ParameterShift {
 public:
  ParameterShift(const Effect& effect, std::size_t parameter, const DiagnosisProblem& problem,
                 const Eigen::VectorXd& scale, std::optional<double> squared_limit)
      : effect_(effect),
        parameter_(parameter),
        metric_(problem.metric),
        scale_(scale),
        error_model_(ErrorModelOf(problem.runs, problem.nominal.boat)),
        own_(problem.recording.errors),
        own_squared_gap_(SquaredGap(own_)),
        is_nominal_(own_squared_gap_ <= squared_limit.value_or(0.0)) {}

  /// How far the parameter at `value` moves the errors.
  ErrorShift At(double value) const {
    const Eigen::MatrixXd shift = ShiftBy(value);
    const double alone = SquaredGap(shift);
    // What an unknown cause does to a recording is no error of a nominal day.
    const double with_own = is_nominal_ ? SquaredGap(own_ + shift) - own_squared_gap_ - alone : 0.0;
    return {metric_.SquaredMahalanobis(metric_.Whiten(shift)), alone, with_own};
  }

 private:
  // A boat with the effect errs by what its model would take off. Large turns of a compass are far
  // from linear; a model of one that is turned the other way errs as the nominal one does on them.
  Eigen::MatrixXd ShiftBy(double value) const {
    if (effect_.Facts().hook == Hook::kHeading) return ErrorsOfModelWith(-value) - own_;
    return own_ - ErrorsOfModelWith(value);
  }

  Eigen::MatrixXd ErrorsOfModelWith(double value) const {
    ModelledEffect modelled{&effect_, {}};
    for (const EffectParameter& other : effect_.Parameters()) {
      modelled.values.push_back(other.prior_mean);
    }
    modelled.values[parameter_] = value;
    return error_model_({modelled});
  }

  double SquaredGap(const Eigen::MatrixXd& errors) const {
    return SquaredGaps(errors, scale_, kAllChannels).mean();
  }

  const Effect& effect_;
  std::size_t parameter_;
  const ResidualMetric& metric_;
  const Eigen::VectorXd& scale_;
  ErrorModel error_model_;
  const Eigen::MatrixXd& own_;  ///< errors of the nominal boat on the recording
  double own_squared_gap_ = 0.0;
  bool is_nominal_ = false;  ///< a nominal day may leave as much
};

/// What decides whether an effect shows, besides what it does to the errors.
struct Gate {
  const PresentWeather& weather;
  const DayToDay& days;
  double nominal_gain = 0.0;
  double parameters = 1.0;    ///< that are fitted
  CandidateEffect candidate;  ///< the cost of its parameters aside
};

/// What the score of a parameter of `sizes` typical sizes pays, (89): its prior and the volume that
/// an estimate leaves of it, as of each parameter of the effect; besides the gain on nominal
/// recordings.
double CostOf(double sizes, double noncentrality, const Gate& gate) {
  const double prior_variance =
      kDiagnosis.effect_fit.prior_width * kDiagnosis.effect_fit.prior_width;
  const ResidualMetric& metric = gate.weather.metric;
  const double left = metric.ExpectedSquare() * std::exp(gate.days.noise.log_mean);
  const double information =
      metric.EffectiveObservations() / left * noncentrality / (sizes * sizes);
  return gate.nominal_gain + sizes * sizes / prior_variance +
         gate.parameters * std::log1p(prior_variance * information);
}

/// The effect beside the weather, whose shapes are as expected.
CandidateEffect CandidateOf(const Effect& effect, const PresentWeather& weather) {
  EffectFit both = weather.fit;
  both.effects.insert(both.effects.begin(), At({&effect, 0}, 0.0));
  HypothesisTraits traits = TraitsOf(both);
  traits.negative_log_prior = 0.0;
  return {traits, ScoreToAdd(effect, weather.fit)};
}

/// The smallest size between zero and `end`; nothing where not even the end of the range shows.
std::optional<double> DetectableTowards(double end, const ParameterShift& shift,
                                        const EffectParameter& parameter, const Gate& gate) {
  const double largest = std::abs(end);
  double hidden = 0.0;          // the largest size that is known not to show
  std::optional<double> shown;  // the smallest one that is known to
  double size = std::min(parameter.typical, largest);
  for (int step = 0; step < kSizeSteps; ++step) {
    const ErrorShift moved = shift.At(std::copysign(size, end));
    if (moved.noncentrality <= 0.0) return std::nullopt;
    CandidateEffect candidate = gate.candidate;
    candidate.traits.score += CostOf(size / parameter.typical, moved.noncentrality, gate);
    const double ratio = SizeRatioFor(moved, candidate, gate.weather, gate.days, kWantedPower);
    if (std::abs(ratio - 1.0) < kSizeTolerance) return size;
    if (ratio > 1.0) {
      hidden = size;
    } else {
      shown = size;
    }
    if (hidden >= largest) return std::nullopt;
    size = std::min(size * ratio, largest);
    const bool is_known = size <= hidden || (shown && size >= *shown);
    if (is_known) size = 0.5 * (hidden + shown.value_or(largest));
  }
  return size < largest ? std::optional(size) : std::nullopt;
}

DetectableSize DetectableSizeOf(const Effect& effect, std::size_t place,
                                const DiagnosisProblem& problem, const Eigen::VectorXd& scale,
                                const Gate& gate) {
  const EffectParameter& parameter = effect.Parameters()[place];
  const ParameterShift shift(effect, place, problem, scale, gate.days.squared_limit);
  DetectableSize detectable{std::string(parameter.name), std::nullopt, std::string(parameter.unit)};
  std::optional<double> largest = 0.0;
  for (const double end : {parameter.lower, parameter.upper}) {
    if (end == 0.0 || !largest) continue;
    const auto size = DetectableTowards(end, shift, parameter, gate);
    largest = size ? std::optional(std::max(*largest, *size)) : std::nullopt;
  }
  detectable.size = largest;
  return detectable;
}

}  // namespace

std::vector<DetectableSize> DetectableSizesOf(const Effect& effect, const DiagnosisProblem& problem,
                                              const PresentWeather& weather,
                                              const Eigen::VectorXd& scale, const DayToDay& days,
                                              double nominal_gain) {
  std::vector<DetectableSize> sizes;
  if (effect.IsStochastic()) return sizes;
  const Gate gate{weather, days, nominal_gain, static_cast<double>(effect.Parameters().size()),
                  CandidateOf(effect, weather)};
  for (std::size_t place = 0; place < effect.Parameters().size(); ++place) {
    if (effect.Parameters()[place].is_shape) continue;
    sizes.push_back(DetectableSizeOf(effect, place, InWeather(problem, weather), scale, gate));
  }
  return sizes;
}

}  // namespace telltale
