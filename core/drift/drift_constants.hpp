#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace telltale {

/// A change that the drift test watches for: one parameter of an effect of the library, in its
/// unit.
struct WatchedChange {
  std::string_view effect;
  std::size_t parameter = 0;
  double step = 0.0;         ///< of the secant; its sign says on which side
  double prior_sd = 0.0;     ///< of the change
  double model_error = 0.0;  ///< that a model may have from the start, at most
  double tolerance = 0.0;    ///< beyond the model's error: a change too small to tell of
};

/// What moves a boat otherwise from day to day and is no drift.
struct WatchedWeather {
  std::string_view effect;
  std::size_t parameter = 0;
  double step = 0.0;
  double prior_sd = 0.0;
};

/// Tuned on boats of bench/drift, seeds from 1001 on; docs/validation/monitoring.md is of other
/// seeds.
struct DriftConstants {
  double window_s = 5.0;                ///< s, of a free run
  double time_constant_s = 180.0;       ///< s, in which the newest state is followed
  double model_error_time_s = 10000.0;  ///< s, in which the model's own error is learnt
  double minimum_count = 20.0;          ///< windows before anything is said
  double alarm_sigmas = 3.5;            ///< standard errors beyond the tolerance
  std::size_t reference_windows = 60;   ///< that the reference needs
  double covariance_shrinkage = 0.15;   ///< 1, share of the diagonal in the errors' covariance
  double least_command_range =
      0.2;  ///< of full command, by which a window tells of thrust and drag
  double least_heading_range_rad = 0.3;  ///< rad, by which a window tells of the compass
  double largest_sigmas = 4.0;           ///< root mean square beyond which a window counts less
  std::array<WatchedChange, 3> changes = {{
      {"thruster_imbalance", 0, 0.1, 0.2, 0.03, 0.05},
      {"thruster_imbalance", 0, -0.1, 0.2, 0.03, 0.05},
      {"hull_fouling", 0, 0.2, 0.25, 0.1, 0.2},
  }};
  std::array<WatchedWeather, 4> weather = {{
      {"wind", 0, 4.0, 4.0},
      {"wind", 1, 4.0, 4.0},
      {"current", 0, 0.1, 0.2},
      {"current", 1, 0.1, 0.2},
  }};
  /// The bias of the compass, rad, which sideslip shows.
  WatchedChange compass = {"heading_bias", 0, 0.0, 0.05, 0.012, 0.035};
  double drift_through_water_sd = 0.2;  ///< m/s, by wind and current
  double sideslip_in_turns_sd = 0.5;    ///< m/s for 1 rad/s, and for 1 m/s times 1 rad/s
};

inline constexpr DriftConstants kDrift;

}  // namespace telltale
