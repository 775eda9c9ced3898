#pragma once

#include <cstddef>

namespace telltale {

/// What makes single bounds joint ones. The covariance behind intervals is sized so that each of
/// them holds by itself; for what is said of several unknowns at once it is another number of times
/// as large:
///   covariance for joint statements = covariance_factor * covariance,
/// and with the probability `level` the truth of q unknowns together lies where
///   off' (covariance_factor * covariance)^-1 off <= q JointQuantile(degrees_of_freedom, q, level).
/// docs/concepts/model.md (35).
struct JointBounds {
  double covariance_factor = 1.0;
  double degrees_of_freedom = 0.0;  ///< independent clusters behind the covariance, less one

  bool operator==(const JointBounds&) const = default;
};

/// The quantile of Fisher's law of q and degrees_of_freedom - q + 1, or 5 where those are fewer:
/// Hotelling's law needs more clusters than unknowns, covariances drawn towards a full shape do
/// not.
double JointQuantile(double degrees_of_freedom, double unknowns, double level);

/// How far the truth may lie from the estimate of this many unknowns together, in squares of the
/// covariance behind the intervals: off' covariance^-1 off <= SquaredRadius(...) at `level`.
/// Requires: at least one unknown, level in (0, 1).
double SquaredRadius(const JointBounds& joint, std::size_t unknowns, double level);

}  // namespace telltale
