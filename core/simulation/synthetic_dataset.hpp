#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// What a simulated repeat of a data set is made with.
struct SyntheticDatasetOptions {
  Disturbance disturbance;   ///< zero: none
  double noise_scale = 1.0;  ///< on the dataset's sensor noise
  std::uint64_t seed = 1;
  /// Velocities (u, v, r) that the model has no equation for: they go as measured.
  std::array<bool, 3> as_measured{};
  std::vector<ConstantDisturbance> constant_disturbances =
      {};  ///< by recording of the dataset; empty: none
};

/// A data set that the same boat might have given another day: every segment of `dataset` sailed
/// anew by `model` from where it began and under the same commands, disturbed and measured with
/// fresh draws, and prepared by the same options.
/// Model: nu_dot = Phi(nu, T) theta + d, d first-order Gauss-Markov per axis; Runge-Kutta at a
/// tenth of a second, poses by Simpson's rule; positions and headings at the dataset's own rates
/// (of headings five a row at most, with as much less noise) with white noise, fixes besides with a
/// slow first-order Gauss-Markov error where they wander. Refuses when: the simulation runs away,
/// or what it gives cannot be prepared.
Result<PreparedDataset> SimulateDataset(const PreparedDataset& dataset, const VesselModel& model,
                                        const SyntheticDatasetOptions& options);

/// A simulated repeat as it comes from the sensors, before any preparation.
struct SyntheticRecording {
  Recording recording;
  Vehicle vehicle;  ///< whose sensors and pulse widths these are
};

/// The same before preparation, for who chooses how to prepare.
/// Refuses when: the simulation runs away.
Result<SyntheticRecording> SimulateRecording(const PreparedDataset& dataset,
                                             const VesselModel& model,
                                             const SyntheticDatasetOptions& options);

}  // namespace telltale
