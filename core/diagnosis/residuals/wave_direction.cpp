#include "telltale/core/diagnosis/residuals/wave_direction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>

#include "telltale/core/base/random.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

using std::numbers::pi;

constexpr WaveDirectionConstants kDirection = kDiagnosis.wave_direction;
constexpr auto kDirections = static_cast<Eigen::Index>(kDirection.directions);
constexpr auto kFrequencies = static_cast<Eigen::Index>(kDirection.frequencies);
constexpr auto kRatios = static_cast<Eigen::Index>(kDirection.force_ratios.size());
constexpr double kGravity = 9.81;  // m/s^2

using Window = std::vector<AccelerationResidual>;

double DirectionAt(Eigen::Index i) {
  return 2.0 * pi * static_cast<double>(i) / static_cast<double>(kDirections);
}

/// How far residuals are taken apart: neighbours hardly differ.
std::size_t StrideOf(double sampling_period_s) {
  return std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(kDirection.row_s / sampling_period_s)));
}

std::vector<Window> WindowsOf(std::span<const AccelerationResidual> residuals,
                              double sampling_period_s) {
  const std::size_t stride = StrideOf(sampling_period_s);
  const auto rows = static_cast<std::size_t>(
      std::lround(kDirection.window_s / (sampling_period_s * static_cast<double>(stride))));
  std::vector<Window> windows;
  for (const auto block : WholeBlocks(residuals, rows * stride, sampling_period_s)) {
    Window& window = windows.emplace_back();
    for (std::size_t k = 0; k < rows; ++k) window.push_back(block[k * stride]);
  }
  return windows;
}

/// W with W V W' = I, V the covariance of a window of one axis without waves.
Eigen::MatrixXd WhiteningBeside(const SpectralPeak& peak, std::size_t axis, Eigen::Index rows,
                                double step_s) {
  const double bandwidth_hz = peak.frequencies_hz[1] - peak.frequencies_hz[0];
  const Eigen::ArrayXd variances = bandwidth_hz * peak.power_beside[axis];
  Eigen::MatrixXd covariance(rows, rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < rows; ++j) {
      const double lag_s = static_cast<double>(i - j) * step_s;
      covariance(i, j) = (variances * (2.0 * pi * lag_s * peak.frequencies_hz).cos()).sum();
    }
  }
  const double variance = variances.sum();
  const Eigen::VectorXd trend = Eigen::VectorXd::LinSpaced(rows, -1.0, 1.0);
  // What is slower than the spectrum tells moves a window's mean and trend.
  covariance += kDirection.unlike_any * variance *
                (Eigen::MatrixXd::Ones(rows, rows) + trend * trend.transpose());
  covariance.diagonal().array() += variance;
  return covariance.llt().matrixL().solve(Eigen::MatrixXd::Identity(rows, rows));
}

/// Frequencies that share the power of the widest peak about that of `peak` evenly, rad/s.
std::array<double, kDirection.frequencies> FrequenciesOf(const SpectralPeak& peak) {
  const double log_width = kDiagnosis.spectral_peak.log_widths.back();
  std::array<double, kDirection.frequencies> frequencies{};
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(frequencies.size());
    frequencies[i] = peak.frequency_rad_s * std::exp(log_width * NormalQuantile(share));
  }
  return frequencies;
}

/// What the filter of the rows leaves of an acceleration.
double GainAt(double frequency_rad_s, const SpectralPeak& peak) {
  const Eigen::ArrayXd& frequencies_hz = peak.frequencies_hz;
  const double step = frequencies_hz[1] - frequencies_hz[0];
  const double last = static_cast<double>(frequencies_hz.size() - 2);
  const double place = (std::abs(frequency_rad_s) / (2.0 * pi) - frequencies_hz[0]) / step;
  const auto i = static_cast<Eigen::Index>(std::clamp(place, 0.0, last));
  const double share = std::clamp(place - static_cast<double>(i), 0.0, 1.0);
  return std::sqrt((1.0 - share) * peak.power_gains[i] + share * peak.power_gains[i + 1]);
}

/// The accelerations of a window's axes by each frequency's cosine and sine.
struct Response {
  Eigen::MatrixXd surge;
  Eigen::MatrixXd sway;
};

/// docs/concepts/diagnosis.md (128).
Response ResponseTo(double towards_rad, const Window& window, std::span<const double> frequencies,
                    const SpectralPeak& peak) {
  const double north = std::cos(towards_rad);
  const double east = std::sin(towards_rad);
  const auto rows = static_cast<Eigen::Index>(window.size());
  Response response{Eigen::MatrixXd(rows, 2 * kFrequencies),
                    Eigen::MatrixXd(rows, 2 * kFrequencies)};
  for (Eigen::Index k = 0; k < rows; ++k) {
    const AccelerationResidual& now = window[static_cast<std::size_t>(k)];
    const double ahead = std::cos(towards_rad - now.eta.psi_rad);
    const double aside = std::sin(towards_rad - now.eta.psi_rad);
    const double along_m = now.eta.x_m * north + now.eta.y_m * east;
    const double speed = now.nu.u * ahead + now.nu.v * aside;
    for (Eigen::Index i = 0; i < kFrequencies; ++i) {
      const double frequency = frequencies[static_cast<std::size_t>(i)];
      const double wave_number = frequency * frequency / kGravity;
      const double phase = frequency * now.time_s - wave_number * along_m;
      const double gain = GainAt(frequency - wave_number * speed, peak);
      const Eigen::RowVector2d wave(gain * std::cos(phase), gain * std::sin(phase));
      response.surge.block<1, 2>(k, 2 * i) = ahead * wave;
      response.sway.block<1, 2>(k, 2 * i) = aside * wave;
    }
  }
  return response;
}

/// Mean square of the cosine of the bearing of each direction.
Eigen::ArrayXd SharesAhead(const std::vector<Window>& windows) {
  Eigen::ArrayXd shares = Eigen::ArrayXd::Zero(kDirections);
  double rows = 0.0;
  for (const Window& window : windows) {
    for (const AccelerationResidual& now : window) {
      for (Eigen::Index i = 0; i < kDirections; ++i) {
        const double ahead = std::cos(DirectionAt(i) - now.eta.psi_rad);
        shares[i] += ahead * ahead;
      }
      rows += 1.0;
    }
  }
  return shares / rows;
}

/// Likelihoods of a window, by direction and ratio of forces.
class DirectionLikelihood {
 public:
  DirectionLikelihood(const std::vector<Window>& windows, const SpectralPeak& peak)
      : peak_(peak),
        frequencies_(FrequenciesOf(peak)),
        whiten_surge_(WhiteningOf(windows.front(), 0)),
        whiten_sway_(WhiteningOf(windows.front(), 1)),
        shares_ahead_(SharesAhead(windows)) {}

  /// ln of each, but for a constant of the window. Shape: directions x ratios.
  Eigen::ArrayXXd Of(const Window& window) const {
    Eigen::VectorXd surge(std::ssize(window));
    Eigen::VectorXd sway(std::ssize(window));
    for (std::size_t k = 0; k < window.size(); ++k) {
      surge[static_cast<Eigen::Index>(k)] = window[k].error[0];
      sway[static_cast<Eigen::Index>(k)] = window[k].error[1];
    }
    surge = whiten_surge_ * surge;
    sway = whiten_sway_ * sway;
    Eigen::ArrayXXd logs(kDirections, kRatios);
    for (Eigen::Index i = 0; i < kDirections; ++i) {
      const Response response = ResponseTo(DirectionAt(i), window, frequencies_, peak_);
      logs.row(i) =
          OfDirection(i, whiten_surge_ * response.surge, whiten_sway_ * response.sway, surge, sway);
    }
    return logs;
  }

 private:
  Eigen::MatrixXd WhiteningOf(const Window& window, std::size_t axis) const {
    return WhiteningBeside(peak_, axis, std::ssize(window), window[1].time_s - window[0].time_s);
  }

  /// The amplitudes of cosines and sines are integrated out.
  Eigen::Array<double, 1, kRatios> OfDirection(Eigen::Index direction,
                                               const Eigen::MatrixXd& by_surge,
                                               const Eigen::MatrixXd& by_sway,
                                               const Eigen::VectorXd& surge,
                                               const Eigen::VectorXd& sway) const {
    const Eigen::MatrixXd surge_square = by_surge.transpose() * by_surge;
    const Eigen::MatrixXd sway_square = by_sway.transpose() * by_sway;
    const Eigen::VectorXd surge_product = by_surge.transpose() * surge;
    const Eigen::VectorXd sway_product = by_sway.transpose() * sway;
    Eigen::Array<double, 1, kRatios> logs;
    for (Eigen::Index j = 0; j < kRatios; ++j) {
      const double ratio = kDirection.force_ratios[static_cast<std::size_t>(j)];
      const double variance = VarianceOf(direction, ratio);
      const Eigen::MatrixXd precision =
          Eigen::MatrixXd::Identity(surge_square.rows(), surge_square.cols()) +
          variance * (surge_square + ratio * ratio * sway_square);
      const Eigen::LLT<Eigen::MatrixXd> factor(precision);
      const Eigen::VectorXd product = std::sqrt(variance) * (surge_product + ratio * sway_product);
      logs[j] = 0.5 * factor.matrixL().solve(product).squaredNorm() -
                factor.matrixLLT().diagonal().array().log().sum();
    }
    return logs;
  }

  /// Of each amplitude, so that both axes together have the power of the peak.
  double VarianceOf(Eigen::Index direction, double ratio) const {
    const double ahead = shares_ahead_[direction];
    const double seen = ahead + ratio * ratio * (1.0 - ahead);
    return peak_.squared_amplitudes.head<2>().sum() /
           (2.0 * static_cast<double>(kFrequencies) * seen);
  }

  const SpectralPeak& peak_;
  std::array<double, kDirection.frequencies> frequencies_;
  Eigen::MatrixXd whiten_surge_;
  Eigen::MatrixXd whiten_sway_;
  Eigen::ArrayXd shares_ahead_;
};

/// Sums of windows that may be correlated.
std::vector<Eigen::ArrayXXd> SumsByHalfMinute(const std::vector<Window>& windows,
                                              const DirectionLikelihood& likelihood) {
  std::map<long, Eigen::ArrayXXd> sums;
  for (const Window& window : windows) {
    const long half_minute =
        std::lround(std::floor(window.front().time_s / kDiagnosis.spectral_peak.block_s));
    const auto [sum, is_new] = sums.try_emplace(half_minute);
    if (is_new) sum->second.setZero(kDirections, kRatios);
    sum->second += likelihood.Of(window);
  }
  std::vector<Eigen::ArrayXXd> all;
  for (auto& [half_minute, sum] : sums) all.push_back(std::move(sum));
  return all;
}

/// Of directions, under a uniform prior of both.
Eigen::ArrayXd PosteriorOf(const Eigen::ArrayXXd& log_likelihoods) {
  const Eigen::ArrayXd likelihoods =
      (log_likelihoods - log_likelihoods.maxCoeff()).exp().rowwise().sum();
  return likelihoods / likelihoods.sum();
}

/// The mean posterior of resampled half minutes, docs/concepts/diagnosis.md (129).
Eigen::ArrayXd BaggedPosterior(const std::vector<Eigen::ArrayXXd>& half_minutes,
                               std::uint64_t seed) {
  RandomEngine engine(seed);
  Eigen::ArrayXd posterior = Eigen::ArrayXd::Zero(kDirections);
  for (std::size_t i = 0; i < kDirection.resamples; ++i) {
    Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(kDirections, kRatios);
    for (std::size_t k = 0; k < half_minutes.size(); ++k) {
      sum += half_minutes[DrawBelow(engine, half_minutes.size())];
    }
    posterior += PosteriorOf(sum);
  }
  return posterior / static_cast<double>(kDirection.resamples);
}

}  // namespace

CircularInterval WaveDirectionOf(std::span<const AccelerationResidual> residuals,
                                 double sampling_period_s, const SpectralPeak& peak,
                                 std::uint64_t seed) {
  const std::vector<Window> windows = WindowsOf(residuals, sampling_period_s);
  if (windows.empty() || peak.gain == 0.0) return {0.0, pi, false};
  const DirectionLikelihood likelihood(windows, peak);
  return ShortestArc(BaggedPosterior(SumsByHalfMinute(windows, likelihood), seed),
                     kDiagnosis.gap.level);
}

}  // namespace telltale
