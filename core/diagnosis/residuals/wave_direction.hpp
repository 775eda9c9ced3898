#pragma once

#include <cstdint>
#include <span>

#include "telltale/core/diagnosis/residuals/acceleration_residuals.hpp"
#include "telltale/core/diagnosis/residuals/spectral_peak.hpp"
#include "telltale/core/uncertainty/circular_interval.hpp"

namespace telltale {

/// The direction towards which waves run, a 95 % interval: any, where no window is whole or the
/// peak has no gain.
/// Model: long-crested waves in deep water about the frequency of the peak, whose force acts along
/// their direction; what else there is has the spectrum beside the peak, and as much white noise.
/// Fossen 2011, chapter 8 (frequency of encounter); docs/concepts/diagnosis.md (128). The posterior
/// is bagged over half minutes, since the sea is never quite so: (129). Huggins and Miller,
/// Reproducible model selection using bagged posteriors, Bayesian Analysis 18 (2023).
/// Residuals are those of a Sharpened recording.
CircularInterval WaveDirectionOf(std::span<const AccelerationResidual> residuals,
                                 double sampling_period_s, const SpectralPeak& peak,
                                 std::uint64_t seed);

}  // namespace telltale
