#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/acceleration_spectra.hpp"

namespace telltale {

/// The peak in the spectrum of the accelerations that a model does not explain.
/// Model: log-normal in frequency.
struct SpectralPeak {
  double frequency_rad_s = 0.0;  ///< the middle one of the power
  double log_width = 0.0;        ///< standard deviation of the logarithm of frequency
  double frequency_standard_error_rad_s = 0.0;  ///< of the grid on which it is sought
  /// Of a cosine of the same variance: (m/s^2)^2, (m/s^2)^2, (rad/s^2)^2.
  Eigen::Vector3d squared_amplitudes = Eigen::Vector3d::Zero();
  Eigen::Vector3d standard_errors = Eigen::Vector3d::Zero();  ///< of the squared amplitudes
  /// 2 ln of how much likelier the spectra are with the peak than without one, less what chance
  /// makes of so many peaks; zero where there is none.
  double gain = 0.0;
  /// Where the filter of the rows leaves enough of an acceleration, what it leaves of the power,
  /// and what each axis has beside the peak. Empty where there is none.
  Eigen::ArrayXd frequencies_hz;
  Eigen::ArrayXd power_gains;
  std::array<Eigen::ArrayXd, 3> power_beside;
};

/// The likeliest peak within [lowest_rad_s, highest_rad_s], by Whittle's likelihood of the
/// QuantileSpectrum: power is exponentially distributed about the spectrum, which is a mixture of
/// broad shapes, with the peak or without it. Broad shapes are the spectrum of the references,
/// accelerations of first order, and positions and headings that walk at random or are noisy.
/// docs/concepts/diagnosis.md (116), (118). Whittle, Arkiv for Matematik 2 (1953).
/// `nominal`: of the references, one at least.
SpectralPeak LikeliestPeak(const AccelerationSpectra& recording,
                           const std::vector<AccelerationSpectra>& nominal, double lowest_rad_s,
                           double highest_rad_s);

}  // namespace telltale
