#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// The sampling periods that a grid may have, in seconds.
inline constexpr double kShortestPeriodS = 0.02;
inline constexpr double kLongestPeriodS = 2.0;

/// The way in which the three channels come onto one grid; docs/concepts/data-preparation.md
/// compares the two.
/// kPaper: causal spline extrapolation from the newest past samples (cubic position, 8th-degree
/// heading, cubic PWM), velocities by differentiation, then Savitzky-Golay on the velocities.
/// kRobust: positions and headings interpolated or averaged about the grid point, displacements
/// turned into the body frame interval by interval, velocities as the slope of one Savitzky-Golay
/// kernel. The held commands are filtered with that kernel's weights on the acceleration, so that
/// row k pairs a command with the velocity change it caused.
enum class Preset { kUnknown, kPaper, kRobust };

/// "PAPER" or "ROBUST".
std::string_view Name(Preset preset);

struct PrepareOptions {
  Preset preset = Preset::kRobust;
  std::optional<double> sampling_period_s =
      std::nullopt;                      ///< [0.02, 2]; unset: the median GNSS period
  std::size_t smoothing_half_width = 8;  ///< Savitzky-Golay rows to each side, [2, 50]
  std::size_t smoothing_degree = 3;      ///< [1, 5], below 2 * half width + 1
  double longest_gap_s = 1.0;       ///< a longer silence of any channel ends a segment, [0.1, 60]
  double shortest_segment_s = 5.0;  ///< shorter segments are dropped, [1, 600]
  double longest_slice_s = 20.0;    ///< slices are cut at this length, [2, 600]
  std::optional<double> longest_segment_s =
      std::nullopt;  ///< segments are cut into equal parts no longer, [10, 86400]; unset: uncut

  static PrepareOptions Paper();
  static PrepareOptions Robust();

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

}  // namespace telltale
