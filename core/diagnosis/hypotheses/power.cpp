#include "telltale/core/diagnosis/hypotheses/power.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

// Days of equal probability.
constexpr int kNodes = 15;
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

double SizeRatioFor(const ErrorShift& shift, const CandidateEffect& candidate,
                    const PresentWeather& weather, const DayToDay& days, double wanted) {
  const DaysAhead ahead(candidate, weather, days);
  const auto power = [&](double square) { return ahead.PowerOf(shift.Times(std::sqrt(square))); };
  double low = 0.0;
  double high = 1.0;
  while (power(high) < wanted && high < kBeyondAnyEffect) {
    low = high;
    high *= 2.0;
  }
  while (high - low > kTolerance * high) {
    const double middle = 0.5 * (low + high);
    (power(middle) < wanted ? low : high) = middle;
  }
  return std::sqrt(high);
}

}  // namespace telltale
