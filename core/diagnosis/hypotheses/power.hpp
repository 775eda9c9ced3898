#pragma once

#include <optional>
#include <vector>

#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"
#include "telltale/core/diagnosis/hypotheses/present_weather.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"

namespace telltale {

/// ln of what one more nominal day leaves: Student's t, what the days there are leave uncertain
/// included.
struct OneMoreDay {
  double log_mean = 0.0;
  double log_sd = 0.0;
  double degrees_of_freedom = 1.0;

  /// Of the quantity itself.
  double Quantile(double probability) const;
};

/// How nominal days differ, as verdict and power see it, docs/concepts/diagnosis.md (100), (123).
struct DayToDay {
  double log_nominal = 0.0;  ///< mean ln of the reduced chi-squares of the baseline's own days
  OneMoreDay noise;          ///< the reduced chi-square of a day
  OneMoreDay squared_gap;    ///< G^2 of a day; of use only beside `squared_limit`
  /// What 99 % of days stay below in G^2; none where fewer than two were left out.
  std::optional<double> squared_limit;
};

/// From days that took no part in the baseline. Where fewer than two did so, the noise is that of
/// the references of the baseline itself, at least one; of a single one an assumed scatter.
DayToDay DayToDayOf(const NominalBaseline& nominal, const std::vector<LeftOutDay>& left_out);

/// How far an effect moves the errors.
struct ErrorShift {
  double noncentrality = 0.0;  ///< squared Mahalanobis distance, by the metric
  double squared_gap = 0.0;    ///< G^2 of the shift alone
  double with_own = 0.0;       ///< twice the product of the shift and the recording's own errors

  double AddedToSquaredGap() const { return squared_gap + with_own; }
  /// Of an effect so many times as large that acts linearly.
  ErrorShift Times(double size) const;
};

/// An effect, beside the weather that is there, before it explains anything.
struct CandidateEffect {
  HypothesisTraits traits;    ///< of both together; its score is that of the weather and the cost
  double score_to_add = 0.0;  ///< by which it has to fall below that of the weather
};

/// The probability that the verdict calls one parameter of an effect, docs/concepts/diagnosis.md
/// (99): it names the effect, or in calm a gap beyond `days.squared_limit`.
double PowerOf(const ErrorShift& shift, const CandidateEffect& candidate,
               const PresentWeather& weather, const DayToDay& days);

/// How many times as large an effect that acts linearly has to be for PowerOf to reach `wanted`.
double SizeRatioFor(const ErrorShift& shift, const CandidateEffect& candidate,
                    const PresentWeather& weather, const DayToDay& days, double wanted);

}  // namespace telltale
