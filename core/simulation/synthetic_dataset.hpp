#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// How a synthetic dataset is made.
struct SyntheticDatasetOptions {
  Disturbance disturbance;   ///< zero: none
  double noise_scale = 1.0;  ///< on the dataset's sensor noise
  std::uint64_t seed = 1;
  /// Velocities (u, v, r) that the model has no equation for: they take the measured values.
  std::array<bool, 3> as_measured{};
  std::vector<ConstantDisturbance> constant_disturbances =
      {};                               ///< by recording of the dataset; empty: none
  Readings readings = Readings::kKept;  ///< of the dataset
};

/// A synthetic dataset, one replicate of the parametric bootstrap. `model` simulates every segment
/// of `dataset` from its first state under its commands, with new draws of disturbance and sensor
/// noise; the same options prepare the result.
/// Model: nu_dot = Phi(nu, T) theta + d, d first-order Gauss-Markov per axis. Velocities follow a
/// Runge-Kutta step of order four at a tenth of a second, poses Simpson's rule. Positions and
/// headings come at the dataset's own rates with white noise; headings at five a row at most, their
/// noise reduced accordingly. GNSS drift is a slow first-order Gauss-Markov error of the fixes.
/// Refuses when: the simulation exceeds kSyntheticDatasetDivergence, or its recording cannot be
/// prepared.
Result<PreparedDataset> SimulateDataset(const PreparedDataset& dataset, const VesselModel& model,
                                        const SyntheticDatasetOptions& options);

/// A synthetic dataset before its preparation.
struct SyntheticRecording {
  Recording recording;
  Vehicle vehicle;  ///< with the antenna and pulse widths of the recording
};

/// The same without the preparation.
/// Refuses when: the simulation exceeds kSyntheticDatasetDivergence.
Result<SyntheticRecording> SimulateRecording(const PreparedDataset& dataset,
                                             const VesselModel& model,
                                             const SyntheticDatasetOptions& options);

}  // namespace telltale
