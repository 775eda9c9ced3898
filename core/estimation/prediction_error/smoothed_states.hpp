#pragma once

#include <vector>

#include "telltale/core/estimation/prediction_error/extended_kalman_filter.hpp"

namespace telltale {

/// A time, and until when readings tell of it.
struct SmoothingWindow {
  double time_s;
  double until_s;  ///< >= time_s
};

/// The states at given times, each from all readings until the end of its own window: a fixed-lag
/// smoother. Empty without a fix and a heading.
/// Requires: times and ends ascend.
/// Source: Bierman, "Fixed interval smoothing with discrete measurements", International Journal of
/// Control 18 (1973), the form that inverts no covariance.
std::vector<FilterState> SmoothedStates(const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings,
                                        const std::vector<SmoothingWindow>& windows);

/// The states at given times, ahead of `start_s`, without any reading.
std::vector<FilterState> PredictedStates(const FilterState& start, double start_s,
                                         const HeldCommands& commands,
                                         const FilterSettings& settings,
                                         const std::vector<double>& times_s);

}  // namespace telltale
