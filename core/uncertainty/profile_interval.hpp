#pragma once

#include <functional>

#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {

/// Where and how far a profile may be followed. The estimate lies in [lowest, highest].
struct ProfileSearch {
  double estimate = 0.0;
  double step = 0.0;  ///< a first step away from it, positive; a standard error, say
  double lowest = 0.0;
  double highest = 0.0;
};

/// The values whose deviance does not exceed `threshold`, about the estimate, at which it is zero:
/// as asymmetric as the likelihood is. docs/concepts/model.md (72).
/// Method: steps doubled until the threshold is passed, then bracketed by TOMS 748 to 1e-3 of the
/// way; an end that is not found within the limits is the limit.
/// Requires: deviance rising away from the estimate on both sides; threshold positive.
Interval ProfileInterval(const std::function<double(double)>& deviance, const ProfileSearch& search,
                         double threshold, double level);

/// Length of the longer side over that of the shorter; 1 for a symmetric interval.
double Asymmetry(const Interval& interval, double estimate);

}  // namespace telltale
