#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace telltale {

/// A change that the drift test watches for: one parameter of an effect of the library, in its
/// unit. In a boat as its model has it the parameter is zero.
struct WatchedChange {
  std::string_view effect;
  std::size_t parameter = 0;
  std::string_view of_what;  ///< it is a change, for people
  double step = 0.0;         ///< of the secant; its sign says on which side
  bool both_signs = false;
  double tolerance = 0.0;               ///< a change up to which the model holds: see below
  double largest_standard_error = 0.0;  ///< beyond it, blocks tell too little of the change
  double alarm_sigmas = 0.0;            ///< standard errors beyond the tolerance
  double reference_slope = 0.0;         ///< of later estimates on those of the reference: see below
};

/// A parameter of what may act on any boat at any time and is no change.
struct WatchedNuisance {
  std::string_view effect;
  std::size_t parameter = 0;
  double step = 0.0;
  double prior_sd = 0.0;
};

/// Calibrated on boats of bench/drift with seeds from 2001 to 2099; docs/validation/monitoring.md
/// is of other seeds.
/// A model fits the recording that made it better than any later one. Of 86 boats to which nothing
/// has happened, the mean of a day's estimates is by least squares 0.55 of the estimate on that
/// recording for thrust, 1.5 for drag and 0.6 for the compass: reference_slope. It differs from
/// that estimate by 0.01 of the thrust of a side, 0.08 of drag and 0.4 degrees (root mean square):
/// a tolerance is four of these or more. Estimates scatter besides by up to thrice their standard
/// errors, since a model errs otherwise in each manoeuvre: alarm_sigmas, a block left out and two
/// evaluations in succession stand for that.
/// In three days of these boats, 4302 spans of five minutes, the errors that follow the commands
/// are 0.2 normal errors (root mean square) and 1.1 at most, where errors of all kinds are 1.3 and
/// up to 3.7: weather makes those.
struct DriftConstants {
  double window_s = 5.0;                      ///< s, of a free run
  std::size_t block_windows = 12;             ///< between evaluations: a minute
  std::array<std::size_t, 2> spans = {5, 9};  ///< blocks over which a change is sought
  /// Of what no change explains; beyond it, errors follow no pattern that is known.
  double largest_residual_variance = 4.0;
  std::size_t reference_windows = 60;    ///< that the reference needs
  double covariance_shrinkage = 0.15;    ///< 1, share of the diagonal in the errors' covariance
  double least_command_range = 0.2;      ///< of full command, by which a window tells of forces
  double least_heading_range_rad = 0.3;  ///< rad, by which a window tells of sideslip
  double largest_sigmas = 4.0;           ///< root mean square beyond which a window counts less
  double largest_error = 10.0;  ///< m or rad, beyond which a run has diverged and does not count
  std::array<WatchedChange, 4> changes = {{
      {"thruster_imbalance", 0, "port thruster", 0.1, false, 0.06, 0.015, 3.0, 0.55},
      {"thruster_imbalance", 0, "starboard thruster", -0.1, false, 0.06, 0.015, 3.0, 0.55},
      {"hull_fouling", 0, "drag", 0.2, false, 0.3, 0.04, 3.0, 1.5},
      {"heading_bias", 0, "compass", 0.05, true, 0.035, 0.0117, 1.0, 0.6},
  }};
  double tolerated_error = 2.0;  ///< that follows the commands, in normal errors: see above
  /// The probability that errors seem to follow the commands by chance: in 8640 spans of five
  /// minutes a month, once. Such an error has to be large besides.
  double chance = 1e-4;
  /// Of what a change explains; another that explains as much of it is not separable.
  double rival_share = 0.8;
  std::array<WatchedNuisance, 7> nuisances = {{
      {"wind", 0, 4.0, 4.0},
      {"wind", 1, 4.0, 4.0},
      {"current", 0, 0.1, 0.3},
      {"current", 1, 0.1, 0.3},
      {"body_bias", 0, 0.02, 0.05},
      {"body_bias", 1, 0.02, 0.05},
      {"body_bias", 2, 0.02, 0.05},
  }};
  double drift_through_water_sd = 0.2;  ///< m/s, north and east, by wind and current
  double sideslip_in_turns_sd = 0.5;    ///< m/s for 1 rad/s, and for 1 m/s times 1 rad/s
  /// Of what free runs say of the compass. Their errors are less independent than sideslips are.
  double free_runs_weight = 0.5;
};

inline constexpr DriftConstants kDrift;

}  // namespace telltale
