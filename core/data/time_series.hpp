#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace telltale {

/// Time stamps closer than this are one instant: a grid of multiples of h and a sensor's own stamps
/// differ by rounding even where they mean the same time.
inline constexpr double kSameInstantS = 1e-6;

/// The value at `t` of the polynomial of degree times.size() - 1 through the given points.
/// Requires: one to sixteen points. Source: Neville's recursion.
double EvaluatePolynomialThrough(std::span<const double> times, std::span<const double> values,
                                 double t);

/// A scalar signal sampled at any times. Times ascend strictly; at least one sample.
struct TimeSeries {
  std::vector<double> times_s;
  std::vector<double> values;

  /// Number of samples not later than `t`.
  std::size_t CountUntil(double t) const;

  /// Causal spline extrapolation, the reading given here to the paper's "nth-degree spline
  /// extrapolation using only previous points": the polynomial piece of that degree through the
  /// newest degree + 1 samples not later than `t` (fewer at the start), evaluated at `t`. Exact on
  /// polynomials up to the degree. One sampling period ahead it amplifies white noise by up to
  /// 2^(degree + 1) - 1, the sum of its weights' sizes: 15 for a cubic, 511 for the 8th degree.
  /// Requires: a sample not later than `t`.
  double Extrapolate(double t, std::size_t degree) const;

  /// Local interpolation from both sides: the cubic through the two neighbours of `t` and one more
  /// sample either side of them, at least half their distance away so that the cubic stays tame;
  /// of lower degree where there is none. Held beyond the ends.
  double Interpolate(double t) const;

  /// Mean over [t - width / 2, t + width / 2] of the signal joined up linearly, cut at the ends:
  /// the noise of all samples within is averaged.
  double MeanAbout(double t, double width_s) const;

 private:
  std::size_t LaterThan(double t) const;  // index of the first sample later than t
  double Linear(double t) const;
};

}  // namespace telltale
