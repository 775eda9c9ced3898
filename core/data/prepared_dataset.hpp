#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/data/held_commands.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/prepare_options.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/time_series.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// One instant of the common sampling grid.
struct PreparedRow {
  double time_s = 0.0;
  Eta eta;  ///< body origin, as the preset filters it; psi unwrapped along a segment
  Nu nu;    ///< body velocity

  /// The command behind nu(k+1) - nu(k): that over [t, t + h), filtered as the preset says. Within
  /// half a smoothing window of a switch a robust row mixes the commands before and after, as its
  /// nu does. It may overshoot [-1, 1] where the nu overshoots.
  PropellerCommand delta;

  /// The region of the commands as sent for most of [t, t + h). Near a switch the filtered delta
  /// may have another sign.
  PropellerRegion region = PropellerRegion::kFF;
};

/// Rows [begin, end) of a dataset.
struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

/// The sensors of a dataset as its samples show them, which a synthetic dataset imitates.
struct SensorProperties {
  double gnss_period_s = 0.0;     ///< mean over the segments
  double heading_period_s = 0.0;  ///< likewise
  double position_noise_m = 0.0;  ///< one sigma of white noise per axis, by WhiteNoise
  double heading_noise_rad = 0.0;
  LeverArm antenna;
  /// Commands change uniformly within so long about their stamps, and never by more than half the
  /// time to the stamp before. Zero: at their stamps.
  double command_spread_s = 0.0;
};

/// The sensor readings along one segment and a little beyond its ends, unfiltered.
struct RawSignals {
  TimeSeries north_m;  ///< of the antenna, in {n}
  TimeSeries east_m;   ///< at the same times
  TimeSeries psi_rad;  ///< unwrapped, on the same turn as the rows
};

/// Synchronised rows at one sampling period, ready for regression.
///
/// segments: gap-free runs of rows, ascending and disjoint. Consecutive rows of a segment are
/// exactly sampling_period_s apart. A free run stays inside a segment.
/// slices: segments cut at each change of propeller region and at the longest slice of the options.
/// They are the independent units of the bootstrap.
struct PreparedDataset {
  double sampling_period_s = 0.0;
  FrameOrigin origin;
  std::vector<PreparedRow> rows;
  std::vector<RowRange> segments;
  std::vector<RowRange> slices;
  /// By segment, the commands before and along it, as they were sent.
  std::vector<HeldCommands> commands;
  std::vector<RawSignals> signals;  ///< by segment; empty where they are left out
  /// By segment, the number of the recording it was cut from, from 0 without a gap. Empty: one
  /// recording.
  std::vector<std::size_t> recordings;
  PrepareOptions options;  ///< how the rows were made
  SensorProperties sensors;
  HullParticulars hull;  ///< as the vehicle file states it, or the defaults
  RejectCounts rejected;
  Nu nu_noise;  ///< one sigma that white sensor noise leaves in each velocity

  std::size_t RecordingOf(std::size_t segment) const {
    return recordings.empty() ? 0 : recordings[segment];
  }
  std::size_t Recordings() const { return recordings.empty() ? 1 : recordings.back() + 1; }

  double StartTime() const { return rows.empty() ? 0.0 : rows.front().time_s; }
  double EndTime() const { return rows.empty() ? 0.0 : rows.back().time_s; }
};

/// The largest absolute velocity of each kind among the rows; RelativeDivergence counts in these.
Nu FastestOf(const PreparedDataset& dataset);

}  // namespace telltale
