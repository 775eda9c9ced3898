#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace telltale {

/// How replicates become an interval: PercentileInterval, StudentizedInterval, BcaInterval.
enum class IntervalMethod { kUnknown, kPercentile, kStudentized, kBca };

std::string_view Name(IntervalMethod method);

/// Bounds that hold the true value with probability `level`.
struct Interval {
  double level = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// estimate -+ t_{(1 + level) / 2, degrees_of_freedom} standard_error.
Interval StudentInterval(double estimate, double standard_error, double degrees_of_freedom,
                         double level);

/// The same with infinite degrees of freedom.
Interval NormalInterval(double estimate, double standard_error, double level);

/// The central `level` of the replicates, by linear interpolation between order statistics
/// (Hyndman and Fan's type 7). Needs at least two replicates.
Interval PercentileInterval(std::span<const double> replicates, double level);

/// Equal tails of draws from a law within [least, greatest], or from an end of this range where
/// that is shorter: equal tails never hold a value at the end. Holds the estimate. Needs a draw.
Interval IntervalWithin(std::vector<double> draws, double estimate, double level,
                        double least = -std::numeric_limits<double>::infinity(),
                        double greatest = std::numeric_limits<double>::infinity());

/// Bootstrap-t: [estimate - t_{upper} standard_error, estimate - t_{lower} standard_error] with the
/// quantiles of t* = (replicate - estimate) / its own standard error. Asymmetric where the
/// distribution is, and second-order correct. Shapes: a standard error, positive, for each
/// replicate; at least two. Source: Efron, Tibshirani, "An Introduction to the Bootstrap" (1993),
/// section 12.5.
Interval StudentizedInterval(double estimate, double standard_error,
                             std::span<const double> replicates,
                             std::span<const double> standard_errors, double level);

/// Bias-corrected and accelerated percentiles: the share of replicates below the estimate tells how
/// far their median is off, the acceleration how the standard error changes with the value. With
/// neither it is the percentile interval, and a monotone change of scale carries it along. Needs at
/// least two replicates. Source: Efron, Tibshirani (1993), section 14.3.
Interval BcaInterval(double estimate, double acceleration, std::span<const double> replicates,
                     double level);

/// The acceleration from estimates that each leave one unit out: a sixth of their skewness, sign
/// turned. 0 where they do not vary.
double JackknifeAcceleration(std::span<const double> leave_one_out);

/// An interval that rules nothing out.
Interval Unbounded(double level);

}  // namespace telltale
