#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// Periodograms of a model's residual accelerations, one for each half minute and axis (surge,
/// sway, yaw), with Hann's taper.
/// Units: Hz; one-sided power in (m/s^2)^2/Hz and (rad/s^2)^2/Hz. Shapes: one value a frequency.
/// docs/concepts/diagnosis.md (116).
struct AccelerationSpectra {
  Eigen::ArrayXd frequencies_hz;
  /// What the filter leaves of the power of an acceleration.
  Eigen::ArrayXd power_gains;
  std::vector<std::array<Eigen::ArrayXd, 3>> half_minutes;
};

/// The recording with rows that are filtered by kDiagnosis.spectral_peak.smoothing_s: its own
/// filter has a zero amid the frequencies of waves. As it is where it has no readings.
PreparedDataset Sharpened(const PreparedDataset& dataset);

/// Of every axis the power that kDiagnosis.spectral_peak.quantile of the half minutes stay below,
/// over what that quantile of so many exponential variables is to their mean: what comes in fewer
/// half minutes than the others leaves no trace. Zero where there is no half minute.
std::array<Eigen::ArrayXd, 3> QuantileSpectrum(
    const std::vector<std::array<Eigen::ArrayXd, 3>>& half_minutes);

/// Of every whole half minute of each segment of the sharpened recording, at the multiples of its
/// inverse up to kDiagnosis.spectral_peak.highest_hz.
AccelerationSpectra AccelerationSpectraOf(const PreparedDataset& recording,
                                          const AugmentedModel& boat);

}  // namespace telltale
