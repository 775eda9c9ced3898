#pragma once

#include "telltale/core/data/prepare_options.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// One sigma of the white noise on each signal of a segment, estimated by WhiteNoise.
struct SignalNoise {
  explicit SignalNoise(const SegmentSignals& signals);

  double north_m = 0.0;
  double east_m = 0.0;
  double psi_rad = 0.0;
};

/// One sigma that this noise leaves in each velocity of the rows. u and v share the noise of north
/// and east, since positions are turned into the body frame.
Nu NoiseInVelocity(const SignalNoise& noise, const SegmentSignals& signals,
                   const SamplingGrid& grid, const PrepareOptions& options);

/// Takes the newest segment into dataset.sensors: periods as means over segments, noise as root
/// mean squares, each segment with the weight of its rows.
/// Requires: the rows of the segment are the dataset's last.
void PoolSensors(PreparedDataset& dataset, const SegmentSignals& signals, const SignalNoise& noise);

/// Takes the newest segment's noise into dataset.nu_noise, a root mean square over segments, each
/// with the weight of its rows. Requires: as PoolSensors.
void PoolNoise(PreparedDataset& dataset, const Nu& of_segment);

}  // namespace telltale
