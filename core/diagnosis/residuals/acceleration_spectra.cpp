#include "telltale/core/diagnosis/residuals/acceleration_spectra.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/acceleration_residuals.hpp"

namespace telltale {
namespace {

using std::numbers::pi;

constexpr SpectralPeakConstants kPeak = kDiagnosis.spectral_peak;

Eigen::ArrayXd Frequencies() {
  const auto first = static_cast<double>(kPeak.first_harmonic);
  const double last = std::floor(kPeak.highest_hz * kPeak.block_s);
  const auto count = static_cast<Eigen::Index>(last - first) + 1;
  return Eigen::ArrayXd::LinSpaced(count, first, last) / kPeak.block_s;
}

double Sinc(double x) {
  return x == 0.0 ? 1.0 : std::sin(x) / x;
}

/// Gain of the rows' velocities: that of the filter, which acts on the mean velocities between
/// rows, docs/concepts/data-preparation.md (1); the paper's preset smooths central differences.
double VelocityGain(const PrepareOptions& options, const SavitzkyGolay& filter, double phase_rad) {
  const std::size_t centre = options.smoothing_half_width;
  std::complex<double> sum = 0.0;
  if (options.preset == Preset::kPaper) {
    const Eigen::RowVectorXd weights = filter.ValueWeights(centre);
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      sum += std::polar(weights[i], phase_rad * static_cast<double>(i));
    }
    return std::abs(sum) * std::abs(Sinc(phase_rad));
  }
  for (std::size_t i = 0; i + 1 < filter.WindowLength(); ++i) {
    sum += std::polar(1.0, phase_rad * static_cast<double>(i)) * filter.IncrementWeight(centre, i);
  }
  return std::abs(sum) * std::abs(Sinc(0.5 * phase_rad));
}

Eigen::ArrayXd PowerGains(const PreparedDataset& dataset, const Eigen::ArrayXd& frequencies_hz) {
  const PrepareOptions& options = dataset.options;
  const SavitzkyGolay filter(options.smoothing_half_width, options.smoothing_degree);
  return frequencies_hz.unaryExpr([&](double frequency_hz) {
    const double phase_rad = 2.0 * pi * frequency_hz * dataset.sampling_period_s;
    // Beyond half the sampling rate lower frequencies show again.
    if (phase_rad >= pi) return 0.0;
    // A residual is the mean acceleration from row to row.
    const double gain = VelocityGain(options, filter, phase_rad) * Sinc(0.5 * phase_rad);
    return gain * gain;
  });
}

/// Columns of the tapered cosines and sines, row by row of a half minute.
Eigen::MatrixXcd TaperedHarmonics(const Eigen::ArrayXd& frequencies_hz, Eigen::Index rows,
                                  double period_s) {
  Eigen::MatrixXcd harmonics(rows, frequencies_hz.size());
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double taper =
        0.5 - 0.5 * std::cos(2.0 * pi * (static_cast<double>(k) + 0.5) / static_cast<double>(rows));
    for (Eigen::Index i = 0; i < frequencies_hz.size(); ++i) {
      const double phase_rad = 2.0 * pi * frequencies_hz[i] * static_cast<double>(k) * period_s;
      harmonics(k, i) = std::polar(taper, -phase_rad);
    }
  }
  // The mean square of Hann's taper is 3/8.
  return harmonics * std::sqrt(2.0 * period_s / (0.375 * static_cast<double>(rows)));
}

std::array<Eigen::ArrayXd, 3> Periodograms(std::span<const AccelerationResidual> residuals,
                                           const Eigen::MatrixXcd& harmonics) {
  Eigen::Matrix3Xd errors(3, std::ssize(residuals));
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    errors.col(static_cast<Eigen::Index>(k)) = Eigen::Vector3d(residuals[k].error.data());
  }
  errors.colwise() -= errors.rowwise().mean().eval();
  const Eigen::MatrixXcd transformed = errors * harmonics;
  std::array<Eigen::ArrayXd, 3> power;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    power[axis] = transformed.row(static_cast<Eigen::Index>(axis)).array().abs2().transpose();
  }
  return power;
}

/// Place of the quantile among so many sorted values.
std::size_t PlaceOfQuantile(std::size_t count) {
  return static_cast<std::size_t>(kPeak.quantile * static_cast<double>(count));
}

/// Expected value at a place among so many sorted exponential variables of mean one; Renyi, Acta
/// Mathematica Hungarica 4 (1953).
double ExpectedAt(std::size_t place, std::size_t count) {
  double expected = 0.0;
  for (std::size_t j = 0; j <= place; ++j) expected += 1.0 / static_cast<double>(count - j);
  return expected;
}

}  // namespace

PreparedDataset Sharpened(const PreparedDataset& dataset) {
  if (dataset.signals.empty()) return dataset;
  PreparedDataset sharp = dataset;
  const auto half_width =
      static_cast<std::size_t>(std::lround(kPeak.smoothing_s / dataset.sampling_period_s));
  sharp.options = PrepareOptions::Robust();
  sharp.options.smoothing_half_width = std::clamp<std::size_t>(
      half_width, kPeak.least_half_width, dataset.options.smoothing_half_width);
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& segment = dataset.segments[s];
    const SegmentSignals signals{dataset.signals[s], dataset.commands[s]};
    const SamplingGrid grid{dataset.rows[segment.begin].time_s, dataset.sampling_period_s,
                            segment.size()};
    std::ranges::copy(PrepareRows(signals, grid, dataset.sensors.antenna, sharp.options),
                      sharp.rows.begin() + static_cast<std::ptrdiff_t>(segment.begin));
  }
  return sharp;
}

std::array<Eigen::ArrayXd, 3> QuantileSpectrum(
    const std::vector<std::array<Eigen::ArrayXd, 3>>& half_minutes) {
  std::array<Eigen::ArrayXd, 3> spectrum;
  spectrum.fill(Eigen::ArrayXd::Zero(Frequencies().size()));
  if (half_minutes.empty()) return spectrum;
  const std::size_t place = PlaceOfQuantile(half_minutes.size());
  const double expected = ExpectedAt(place, half_minutes.size());
  std::vector<double> powers(half_minutes.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    spectrum[axis].resize(half_minutes.front()[axis].size());
    for (Eigen::Index i = 0; i < spectrum[axis].size(); ++i) {
      std::ranges::transform(half_minutes, powers.begin(),
                             [&](const auto& half_minute) { return half_minute[axis][i]; });
      std::ranges::nth_element(powers, powers.begin() + static_cast<std::ptrdiff_t>(place));
      spectrum[axis][i] = powers[place] / expected;
    }
  }
  return spectrum;
}

AccelerationSpectra AccelerationSpectraOf(const PreparedDataset& recording,
                                          const AugmentedModel& boat) {
  const PreparedDataset sharp = Sharpened(recording);
  AccelerationSpectra spectra{Frequencies(), PowerGains(sharp, Frequencies()), {}};
  const double period_s = sharp.sampling_period_s;
  const auto rows = static_cast<std::size_t>(std::lround(kPeak.block_s / period_s));
  const Eigen::MatrixXcd harmonics =
      TaperedHarmonics(spectra.frequencies_hz, static_cast<Eigen::Index>(rows), period_s);
  const std::vector<AccelerationResidual> residuals = AccelerationResidualsOf(sharp, boat);
  for (const auto half_minute : WholeBlocks(residuals, rows, period_s)) {
    spectra.half_minutes.push_back(Periodograms(half_minute, harmonics));
  }
  return spectra;
}

}  // namespace telltale
