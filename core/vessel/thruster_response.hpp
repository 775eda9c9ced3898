#pragma once

namespace telltale {

/// A first-order lag under a held command falls back by exp(-t / tau) of what it was behind.
/// Everything a sampling period of length h needs to know of it, from the lag in periods, tau / h.
struct LagPerPeriod {
  /// Share still behind at the end of the period: exp(-h / tau), the paper's alpha.
  double remaining = 0.0;
  /// Share behind on average over the period: (tau / h) (1 - remaining); zero without lag.
  double mean = 0.0;
  /// Their derivatives by tau / h.
  double remaining_slope = 0.0;
  double mean_slope = 1.0;
};

/// Requires: periods >= 0.
LagPerPeriod LagOver(double periods);

}  // namespace telltale
