#pragma once

#include <span>

namespace telltale {

/// Bounds that hold the true value with probability `level`.
struct Interval {
  double level = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// estimate -+ t_{(1 + level) / 2, degrees_of_freedom} standard_error.
Interval StudentInterval(double estimate, double standard_error, double degrees_of_freedom,
                         double level);

/// The same with endless degrees of freedom.
Interval NormalInterval(double estimate, double standard_error, double level);

/// The central `level` of the replicates, by linear interpolation between order statistics
/// (Hyndman and Fan's type 7). Needs at least two replicates.
Interval PercentileInterval(std::span<const double> replicates, double level);

/// An interval that rules nothing out.
Interval Unbounded(double level);

}  // namespace telltale
