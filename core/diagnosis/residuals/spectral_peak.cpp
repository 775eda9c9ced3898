#include "telltale/core/diagnosis/residuals/spectral_peak.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

using std::numbers::pi;

constexpr SpectralPeakConstants kPeak = kDiagnosis.spectral_peak;
constexpr double kNoPower = 1e-12;  // (m/s^2)^2/Hz, far below what any sensor leaves

/// Neighbouring frequencies of Hann's taper are correlated: so many are independent, of each.
constexpr double kIndependent = 2.0 / 3.0;

/// A spectrum as a mixture of shapes, one a column, each with a weight of zero or more.
struct Mixture {
  Eigen::VectorXd weights;
  Eigen::ArrayXd spectrum;
};

Mixture Weighted(const Eigen::MatrixXd& shapes, const Eigen::VectorXd& weights) {
  return {weights, (shapes * weights).array().max(kNoPower)};
}

/// Raises the likelihood by multiplicative updates, which keep weights positive; Fevotte, Bertin
/// and Durrieu, Neural Computation 21 (2009).
Mixture Fitted(const Eigen::ArrayXd& power, const Eigen::MatrixXd& shapes, Mixture mixture,
               int iterations) {
  for (int i = 0; i < iterations; ++i) {
    const Eigen::ArrayXd inverse = mixture.spectrum.inverse();
    const Eigen::ArrayXd wanted = shapes.transpose() * (power * inverse.square()).matrix();
    const Eigen::ArrayXd expected = shapes.transpose() * inverse.matrix();
    mixture = Weighted(shapes, mixture.weights.array() * wanted / expected);
  }
  return mixture;
}

/// Every shape with the same share of the power.
Mixture EvenMixture(const Eigen::ArrayXd& power, const Eigen::MatrixXd& shapes) {
  const double share = power.mean() / static_cast<double>(shapes.cols());
  return Weighted(shapes, (shapes.colwise().mean().array().inverse() * share).matrix().transpose());
}

/// What the quantile of exponential variables tells of their mean, as a share of what all of them
/// do: the inverse of the relative variance of the quantile.
double Efficiency() {
  const double log_above = std::log(1.0 - kPeak.quantile);
  return log_above * log_above * (1.0 - kPeak.quantile) / kPeak.quantile;
}

/// The first shapes, those of a nominal boat and of forces that vary more slowly than waves.
constexpr Eigen::Index kSlowShapes = 3;

/// The shapes that spectra without a peak are mixed of.
Eigen::MatrixXd BroadShapes(const Eigen::ArrayXd& nominal, const Eigen::ArrayXd& frequencies_hz,
                            const Eigen::ArrayXd& power_gains) {
  constexpr auto kCorners = kPeak.corners_hz;
  Eigen::MatrixXd shapes(frequencies_hz.size(), 3 + std::ssize(kCorners));
  shapes.col(0) = nominal;
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    shapes.col(1 + static_cast<Eigen::Index>(i)) =
        power_gains / (1.0 + (frequencies_hz / kCorners[i]).square());
  }
  const Eigen::ArrayXd squared_rates = (2.0 * pi * frequencies_hz).square();
  shapes.rightCols(2) << power_gains * squared_rates,  // a position that walks at random
      power_gains * squared_rates.square();            // a noisy position
  return shapes;
}

/// The frequencies at which the filter of the rows leaves enough of an acceleration.
std::vector<Eigen::Index> SeenFrequencies(const AccelerationSpectra& spectra) {
  std::vector<Eigen::Index> seen;
  for (Eigen::Index i = 0; i < spectra.power_gains.size(); ++i) {
    if (spectra.power_gains[i] >= kPeak.least_power_gain) seen.push_back(i);
  }
  return seen;
}

/// The spectrum of one axis, and what it is mixed of without a peak.
struct BroadFit {
  Eigen::ArrayXd power;
  Eigen::MatrixXd shapes;
  Mixture mixture;
  double observations = 0.0;  ///< independent ones of each frequency
  double allowance = 0.0;     ///< of -2 ln likelihood, for what the shapes themselves may be off

  /// -2 ln of Whittle's likelihood.
  double Deviance(const Mixture& of) const {
    return 2.0 * observations * (of.spectrum.log() + power / of.spectrum).sum();
  }
};

BroadFit FitBroad(const Eigen::ArrayXd& power, const Eigen::ArrayXd& nominal,
                  const Eigen::MatrixXd& shapes, double observations) {
  BroadFit fit{power, shapes, Fitted(power, shapes, EvenMixture(power, shapes), kPeak.iterations),
               observations, 0.0};
  fit.allowance = 2.0 * observations * kPeak.shape_error *
                  (fit.mixture.spectrum / nominal.max(kNoPower)).log().abs().sum();
  return fit;
}

/// The mixture with the peak, the last shape.
Mixture WithPeak(const Eigen::ArrayXd& power, const Eigen::MatrixXd& shapes, const Mixture& without,
                 const Eigen::ArrayXd& peak) {
  Eigen::MatrixXd all(shapes.rows(), shapes.cols() + 1);
  all << shapes, peak.matrix();
  Eigen::VectorXd weights(all.cols());
  weights << (1.0 - kPeak.initial_share) * without.weights,
      kPeak.initial_share * power.mean() / peak.mean();
  return Fitted(power, all, Weighted(all, weights), kPeak.iterations);
}

/// The spectra of a recording at the frequencies that are seen.
struct SeenSpectra {
  Eigen::ArrayXd frequencies_hz;
  Eigen::ArrayXd power_gains;
  std::array<BroadFit, 3> axes;
};

std::array<Eigen::ArrayXd, 3> SpectrumOf(const std::vector<AccelerationSpectra>& nominal) {
  std::vector<std::array<Eigen::ArrayXd, 3>> all;
  for (const AccelerationSpectra& day : nominal) {
    all.insert(all.end(), day.half_minutes.begin(), day.half_minutes.end());
  }
  return QuantileSpectrum(all);
}

SeenSpectra SeenSpectraOf(const AccelerationSpectra& recording,
                          const std::vector<AccelerationSpectra>& nominal) {
  const std::vector<Eigen::Index> seen = SeenFrequencies(recording);
  const std::array<Eigen::ArrayXd, 3> references = SpectrumOf(nominal);
  const std::array<Eigen::ArrayXd, 3> powers = QuantileSpectrum(recording.half_minutes);
  const double observations =
      kIndependent * Efficiency() * static_cast<double>(recording.half_minutes.size());
  SeenSpectra spectra{recording.frequencies_hz(seen), recording.power_gains(seen), {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::ArrayXd reference = references[axis](seen).max(kNoPower);
    spectra.axes[axis] =
        FitBroad(powers[axis](seen), reference,
                 BroadShapes(reference, spectra.frequencies_hz, spectra.power_gains), observations);
  }
  return spectra;
}

/// Of a peak of unit variance.
Eigen::ArrayXd ShapeOf(const SpectralPeak& peak, const SeenSpectra& spectra) {
  const Eigen::ArrayXd& frequencies_hz = spectra.frequencies_hz;
  const double frequency_hz = peak.frequency_rad_s / (2.0 * pi);
  const Eigen::ArrayXd distances = (frequencies_hz / frequency_hz).log() / peak.log_width;
  return spectra.power_gains * (-0.5 * distances.square()).exp() /
         (frequencies_hz * peak.log_width * std::sqrt(2.0 * pi));
}

/// What a peak gains on all axes.
double GainOf(const SpectralPeak& peak, const SeenSpectra& spectra) {
  const Eigen::ArrayXd shape = ShapeOf(peak, spectra);
  double gain = 0.0;
  for (const BroadFit& broad : spectra.axes) {
    const Mixture with = WithPeak(broad.power, broad.shapes, broad.mixture, shape);
    // A weight of zero or more gains half on average where there is no peak.
    gain += broad.Deviance(broad.mixture) - broad.Deviance(with) - 0.5 - broad.allowance;
  }
  return gain;
}

/// Once there is a peak, what is as fast is of it: the spectrum of a sea is broader than the shape.
void EstimateAmplitudes(const SeenSpectra& spectra, SpectralPeak& peak) {
  const Eigen::ArrayXd shape = ShapeOf(peak, spectra);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const BroadFit& broad = spectra.axes[static_cast<std::size_t>(axis)];
    const Eigen::MatrixXd slow = broad.shapes.leftCols(kSlowShapes);
    const Mixture with = WithPeak(broad.power, slow, EvenMixture(broad.power, slow), shape);
    const double information = broad.observations * (shape / with.spectrum).square().sum();
    peak.squared_amplitudes[axis] = 2.0 * with.weights.tail(1)[0];
    peak.standard_errors[axis] = 2.0 / std::sqrt(information);
    peak.power_beside[static_cast<std::size_t>(axis)] =
        (slow * with.weights.head(kSlowShapes)).array();
  }
}

}  // namespace

SpectralPeak LikeliestPeak(const AccelerationSpectra& recording,
                           const std::vector<AccelerationSpectra>& nominal, double lowest_rad_s,
                           double highest_rad_s) {
  SpectralPeak likeliest;
  likeliest.frequency_rad_s = lowest_rad_s;
  if (recording.half_minutes.empty()) return likeliest;
  const SeenSpectra spectra = SeenSpectraOf(recording, nominal);
  const double step = std::log(highest_rad_s / lowest_rad_s) / (kPeak.frequencies - 1.0);
  const auto peaks = static_cast<double>(kPeak.frequencies * kPeak.log_widths.size());
  for (std::size_t i = 0; i < kPeak.frequencies; ++i) {
    for (const double log_width : kPeak.log_widths) {
      SpectralPeak peak;
      peak.frequency_rad_s = lowest_rad_s * std::exp(step * static_cast<double>(i));
      peak.log_width = log_width;
      // Trying every peak costs 2 ln of their number.
      peak.gain = GainOf(peak, spectra) - 2.0 * std::log(peaks);
      if (peak.gain > likeliest.gain) likeliest = peak;
    }
  }
  if (likeliest.gain == 0.0) return likeliest;
  likeliest.frequencies_hz = spectra.frequencies_hz;
  likeliest.power_gains = spectra.power_gains;
  EstimateAmplitudes(spectra, likeliest);
  // The standard deviation of a uniform law over a step of the grid.
  likeliest.frequency_standard_error_rad_s = likeliest.frequency_rad_s * step / std::sqrt(12.0);
  return likeliest;
}

}  // namespace telltale
