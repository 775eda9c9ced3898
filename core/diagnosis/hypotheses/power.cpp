#include "telltale/core/diagnosis/hypotheses/power.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"
#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr double kWantedPower = kDiagnosis.testability.power;
// Days of equal probability.
constexpr int kNodes = 15;
// The distance that an effect moves errors grows with the square of its size as long as it acts
// linearly, so that few steps do.
constexpr int kSizeSteps = 8;
constexpr double kSizeTolerance = 0.01;
constexpr double kTolerance = 1e-3;        // of a square
constexpr double kBeyondAnyEffect = 1e12;  // of a square, over what a nominal boat leaves

/// Tail of a noncentral chi-squared variable of one degree of freedom, the square of a normal one.
double NoncentralTail(double noncentrality, double x) {
  const double mean = std::sqrt(noncentrality);
  return NormalTail(std::sqrt(x) - mean) + NormalTail(std::sqrt(x) + mean);
}

/// What a verdict goes by, once an effect explains a part of the errors.
struct Evidence {
  HypothesisTraits hypothesis;
  LackOfFit lack_of_fit;
  double score_of_weather = 0.0;  ///< without the effect
  double score_to_add = 0.0;
};

/// The days that may follow, of equal probability, and what each asks of an effect.
class DaysAhead {
 public:
  DaysAhead(const CandidateEffect& candidate, const PresentWeather& weather, const DayToDay& days)
      : candidate_(candidate), weather_(weather), squared_limit_(days.squared_limit) {
    const auto is_material = weather.IsCalm() ? IsMaterial : IsNamedBesideWeather;
    const auto is_named = weather.IsCalm() ? IsNamed : IsNamedBesideWeather;
    for (int node = 0; node < kNodes; ++node) {
      const double probability = (node + 0.5) / kNodes;
      const double noise = days.noise.Quantile(probability);
      // A day that errs more does so by either measure.
      const double squared_gap = squared_limit_ ? days.squared_gap.Quantile(probability) : 0.0;
      days_.push_back({noise, squared_gap,
                       LeastExplained(noise, std::exp(days.log_nominal), is_material),
                       LeastExplained(noise, std::exp(days.log_nominal), is_named)});
    }
  }

  /// The probability that an effect is called which moves the errors so far.
  double PowerOf(const ErrorShift& shift) const {
    double power = 0.0;
    for (const Day& day : days_) {
      const bool is_beyond =
          !squared_limit_ || day.squared_gap + shift.AddedToSquaredGap() > *squared_limit_;
      const double least = is_beyond ? day.material : day.named;
      power += least <= 0.0 ? 1.0 : NoncentralTail(shift.noncentrality / day.noise, least);
    }
    return power / kNodes;
  }

 private:
  struct Day {
    double noise = 1.0;        ///< reduced chi-square without the effect
    double squared_gap = 0.0;  ///< G^2 without the effect
    double material = 0.0;  ///< square that an effect explains, over the noise, of a material gap
    double named = 0.0;     ///< the same, where the gap's cause is named besides
  };

  static bool IsMaterial(const Evidence& evidence) {
    return AssessGap(0.0, 0.0, 1.0, evidence.hypothesis.score, evidence.lack_of_fit) ==
           GapAssessment::kMaterial;
  }

  /// Of an effect whose shape is as expected.
  static bool IsCertainOf(const Evidence& evidence) {
    const double unknown = UnknownProbability(evidence.lack_of_fit, evidence.hypothesis);
    const double gain = evidence.hypothesis.score - evidence.score_of_weather;
    return IsCertain((1.0 - unknown) / (1.0 + std::exp(0.5 * gain)));
  }

  static bool IsNamed(const Evidence& evidence) {
    return IsMaterial(evidence) && IsCertainOf(evidence);
  }

  /// The weather makes a gap by itself: a gap says nothing of the effect until it is named.
  static bool IsNamedBesideWeather(const Evidence& evidence) {
    return evidence.hypothesis.score < evidence.score_of_weather - evidence.score_to_add &&
           IsCertainOf(evidence);
  }

  /// The least square over the noise that an effect has to explain for the verdict to be so; the
  /// more it explains, the surer is the verdict.
  double LeastExplained(double noise, double nominal, bool (*is_so)(const Evidence&)) const {
    const ResidualMetric& metric = weather_.metric;
    const auto is_so_at = [&](double square) {
      const double share = square / metric.ExpectedSquare();
      HypothesisTraits hypothesis = candidate_.traits;
      hypothesis.score -= metric.EffectiveObservations() * std::log1p(share);
      return is_so({hypothesis,
                    {.before = noise * (1.0 + share) + weather_.excess,
                     .after = noise,
                     .nominal = nominal,
                     .median = kDiagnosis.ranking.nominal_median * noise},
                    weather_.fit.score,
                    candidate_.score_to_add});
    };
    if (is_so_at(0.0)) return 0.0;
    double low = 0.0;
    double high = metric.ExpectedSquare();
    while (!is_so_at(high)) {
      low = high;
      high *= 2.0;
      if (high > kBeyondAnyEffect * metric.ExpectedSquare()) return high;
    }
    while (high - low > kTolerance * high) {
      const double middle = 0.5 * (low + high);
      (is_so_at(middle) ? high : low) = middle;
    }
    return high;
  }

  const CandidateEffect& candidate_;
  const PresentWeather& weather_;
  std::optional<double> squared_limit_;
  std::vector<Day> days_;
};

/// How many times as large an effect has to be for PowerOf to reach kWantedPower.
double SizeRatioFor(const ErrorShift& shift, const CandidateEffect& candidate,
                    const PresentWeather& weather, const DayToDay& days) {
  const DaysAhead ahead(candidate, weather, days);
  const auto power = [&](double square) { return ahead.PowerOf(shift.Times(std::sqrt(square))); };
  double low = 0.0;
  double high = 1.0;
  while (power(high) < kWantedPower && high < kBeyondAnyEffect) {
    low = high;
    high *= 2.0;
  }
  while (high - low > kTolerance * high) {
    const double middle = 0.5 * (low + high);
    (power(middle) < kWantedPower ? low : high) = middle;
  }
  return std::sqrt(high);
}

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
        own_(error_model_({})),
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
  Eigen::MatrixXd own_;  ///< errors of the nominal boat on the recording
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
    const double ratio = SizeRatioFor(moved, candidate, gate.weather, gate.days);
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

/// The law of one more day from ln of those there are; `least_sd` where they agree better, an
/// assumed scatter where there is one alone.
OneMoreDay OneMoreDayOf(const std::vector<double>& logs, double least_sd) {
  const auto count = static_cast<double>(logs.size());
  OneMoreDay day;
  for (const double log : logs) day.log_mean += log / count;
  double variance = kDiagnosis.gap.single_recording_sd * kDiagnosis.gap.single_recording_sd;
  if (logs.size() > 1) {
    variance = 0.0;
    for (const double log : logs) {
      variance += (log - day.log_mean) * (log - day.log_mean) / (count - 1.0);
    }
  }
  day.log_sd = std::max(std::sqrt(variance), least_sd) * std::sqrt(1.0 + 1.0 / count);
  day.degrees_of_freedom = std::max(count - 1.0, 1.0);
  return day;
}

}  // namespace

double OneMoreDay::Quantile(double probability) const {
  return std::exp(log_mean + log_sd * StudentQuantile(degrees_of_freedom, probability));
}

DayToDay DayToDayOf(const NominalBaseline& nominal, const std::vector<LeftOutDay>& left_out) {
  DayToDay days;
  days.noise = OneMoreDayOf(nominal.log_reduced_chi_squares, 0.0);
  days.log_nominal = days.noise.log_mean;
  if (left_out.size() < 2) return days;
  std::vector<double> log_noises;
  std::vector<double> log_gaps;
  std::vector<double> squared_gaps;
  for (const LeftOutDay& day : left_out) {
    log_noises.push_back(std::log(day.reduced_chi_square));
    log_gaps.push_back(std::log(day.squared_gap));
    squared_gaps.push_back(day.squared_gap);
  }
  days.noise = OneMoreDayOf(log_noises, 0.0);
  days.squared_gap = OneMoreDayOf(log_gaps, kDiagnosis.gap.minimum_sd);
  days.squared_limit = SquaredLimitOfDays(squared_gaps);
  return days;
}

ErrorShift ErrorShift::Times(double size) const {
  return {size * size * noncentrality, size * size * squared_gap, size * with_own};
}

double PowerOf(const ErrorShift& shift, const CandidateEffect& candidate,
               const PresentWeather& weather, const DayToDay& days) {
  return DaysAhead(candidate, weather, days).PowerOf(shift);
}

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
