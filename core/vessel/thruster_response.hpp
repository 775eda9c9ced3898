#pragma once

namespace telltale {

/// The time constants that estimators search, in seconds.
inline constexpr double kShortestTimeConstantS = 0.01;
inline constexpr double kLongestTimeConstantS = 20.0;

/// The shortest time constant that a solver simulates, in seconds: its step then stays defined.
inline constexpr double kShortestSimulatedTimeConstantS = 1e-3;

/// How far back a command still moves the thrust noticeably, in seconds.
inline constexpr double kThrusterMemoryS = 30.0;

/// What a sampling period of length h needs to know of a first-order lag, from the lag in periods,
/// tau / h. Under a held command the deviation from the steady value decays by exp(-t / tau);
/// docs/concepts/model.md (8).
struct LagPerPeriod {
  /// Share of the deviation that remains at the end of the period: exp(-h / tau), the paper's
  /// alpha.
  double remaining = 0.0;
  /// Share of it on average over the period: (tau / h) (1 - remaining); zero without lag.
  double mean = 0.0;
  /// Their derivatives by tau / h.
  double remaining_slope = 0.0;
  double mean_slope = 1.0;
};

/// Requires: periods >= 0.
LagPerPeriod LagOver(double periods);

/// The value between `start` and `steady` at which `share` of their difference remains.
template <class Value>
Value Approach(const Value& start, const Value& steady, double share) {
  return steady + share * (start - steady);
}

}  // namespace telltale
