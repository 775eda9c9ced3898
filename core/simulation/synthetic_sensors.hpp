#pragma once

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"
#include "telltale/core/simulation/synthetic_track.hpp"

namespace telltale {

/// The sensors of a dataset along simulated segments: fixes at the GNSS period with white noise and
/// drift, headings with white noise at five a row at most, and the commands as they were sent.
/// Where headings are fewer than the sensor's, their noise is scaled so that the mean over a row
/// keeps its variance.
class SyntheticSensors {
 public:
  SyntheticSensors(const PreparedDataset& dataset, const SyntheticDatasetOptions& options);

  /// Appends what the sensors report along one segment, its commands one second past its end.
  void Record(const SimulatedSegment& segment, const SyntheticTrack& track, Recording& recording);

 private:
  GnssFix Fix(double t, const Eta& eta);

  SensorProperties sensors_;
  NorthEastFrame frame_;
  WhiteSource north_;
  WhiteSource east_;
  WhiteSource heading_;
  GaussMarkov drift_north_;
  GaussMarkov drift_east_;
  double heading_period_s_ = 0.0;
  double position_noise_m_ = 0.0;
  double heading_noise_rad_ = 0.0;
};

}  // namespace telltale
