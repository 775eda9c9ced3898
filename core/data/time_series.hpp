#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace telltale {

/// Time stamps closer than this are one instant: the stamps of a grid and of a sensor differ by
/// rounding where they mean the same time. Units: seconds.
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

  /// The samples in [from, to), so that parts of a series that meet share none.
  TimeSeries Within(double from_s, double to_s) const;

  /// Causal spline extrapolation: the polynomial of that degree through the newest degree + 1
  /// samples not later than `t` (fewer at the start), evaluated at `t`. Exact on polynomials up to
  /// the degree. One sampling period ahead it amplifies white noise by up to 2^(degree + 1) - 1,
  /// the sum of its weights' sizes: 15 for a cubic, 511 for the 8th degree. Source: this is how the
  /// paper's "nth-degree spline extrapolation using only previous points" is read. Requires: a
  /// sample not later than `t`.
  double Extrapolate(double t, std::size_t degree) const;

  /// Local interpolation from both sides: the cubic through the two neighbours of `t` and one more
  /// sample on either side. Those are at least half the neighbours' distance away, which bounds the
  /// cubic between them. The degree is lower where there is no such sample. Held beyond the ends.
  double Interpolate(double t) const;

  /// Linear between the two neighbours of `t`, held beyond the ends.
  double Linear(double t) const;

  /// Mean over [t - width / 2, t + width / 2] of the linearly interpolated signal, cut at the ends.
  /// It averages the noise of all samples within.
  double MeanAbout(double t, double width_s) const;

 private:
  std::size_t LaterThan(double t) const;  // index of the first sample later than t
};

}  // namespace telltale
