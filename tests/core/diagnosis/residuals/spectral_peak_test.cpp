#include "telltale/core/diagnosis/residuals/spectral_peak.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>
#include <boost/random/exponential_distribution.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

using Spectrum = std::function<double(double frequency_hz)>;

constexpr double kLowest = 0.8;   // rad/s
constexpr double kHighest = 6.0;  // rad/s

/// Periodograms about a spectrum in each half minute: exponential variables, as Whittle has it. The
/// filter leaves all of an acceleration.
AccelerationSpectra Drawn(std::size_t half_minutes, std::uint64_t seed,
                          const std::function<Spectrum(std::size_t half_minute)>& spectrum_of) {
  AccelerationSpectra spectra;
  spectra.frequencies_hz = Eigen::ArrayXd::LinSpaced(29, 2.0, 30.0) / 30.0;
  spectra.power_gains = Eigen::ArrayXd::Ones(29);
  RandomEngine engine(seed);
  boost::random::exponential_distribution<double> exponential;
  for (std::size_t k = 0; k < half_minutes; ++k) {
    const Spectrum spectrum = spectrum_of(k);
    auto& axes = spectra.half_minutes.emplace_back();
    for (auto& power : axes) {
      power = spectra.frequencies_hz.unaryExpr(
          [&](double frequency_hz) { return spectrum(frequency_hz) * exponential(engine); });
    }
  }
  return spectra;
}

/// Noise of positions: the second derivative of white noise.
double Nominal(double frequency_hz) {
  return 1e-3 * std::pow(frequency_hz, 4) + 1e-5;
}

/// Pierson and Moskowitz' spectrum of that variance and peak; Fossen 2011, section 8.2.
double Sea(double frequency_hz, double variance, double peak_hz) {
  const double ratio = std::pow(peak_hz / frequency_hz, 4);
  return 5.0 * variance * ratio / frequency_hz * std::exp(-1.25 * ratio);
}

AccelerationSpectra Calm(std::uint64_t seed) {
  return Drawn(20, seed, [](std::size_t) { return Nominal; });
}

SpectralPeak PeakOf(const AccelerationSpectra& recording) {
  return LikeliestPeak(recording, {Calm(1), Calm(2), Calm(3), Calm(4)}, kLowest, kHighest);
}

SpectralPeak PeakOfSpectrum(const Spectrum& spectrum) {
  return PeakOf(Drawn(20, 7, [&](std::size_t) { return spectrum; }));
}

class SeaOfPeak : public ::testing::TestWithParam<double> {};

// The logarithm of frequency has its mean 0.2 above the top of this spectrum and a standard
// deviation of 0.32: y = 1.25 (peak / f)^4 is exponential, and E ln y = -0.577. Two steps of the
// grid of 13 % to either side.
TEST_P(SeaOfPeak, IsFoundWithItsFrequencyAndSize) {
  const double peak_hz = GetParam();
  constexpr double kVariance = 5e-3;
  const SpectralPeak found = PeakOfSpectrum([&](double frequency_hz) {
    return Nominal(frequency_hz) + Sea(frequency_hz, kVariance, peak_hz);
  });
  EXPECT_GT(found.gain, 20.0);
  const double frequency_hz = found.frequency_rad_s / (2.0 * std::numbers::pi);
  EXPECT_NEAR(std::log(frequency_hz / peak_hz), 0.2, 0.25);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(found.squared_amplitudes[axis], 2.0 * kVariance,
                0.25 * 2.0 * kVariance + 3.0 * found.standard_errors[axis])
        << axis;
  }
}

INSTANTIATE_TEST_SUITE_P(Hertz, SeaOfPeak, ::testing::Values(0.2, 0.3, 0.5));

TEST(LikeliestPeak, IsNoneInACalm) {
  EXPECT_EQ(PeakOf(Calm(11)).gain, 0.0);
}

TEST(LikeliestPeak, IsNoneInNoiseThatGrew) {
  EXPECT_EQ(PeakOfSpectrum([](double f) { return 30.0 * Nominal(f); }).gain, 0.0);
}

TEST(LikeliestPeak, IsNoneInForcesOfFirstOrder) {
  for (const double corner_hz : {0.02, 0.05, 0.2}) {
    EXPECT_EQ(PeakOfSpectrum([&](double f) {
                return Nominal(f) + 0.01 / (1.0 + std::pow(f / corner_hz, 2));
              }).gain,
              0.0)
        << corner_hz;
  }
}

TEST(LikeliestPeak, IsNoneInPositionsThatWalkAtRandom) {
  EXPECT_EQ(PeakOfSpectrum([](double f) { return Nominal(f) + 0.05 * f * f; }).gain, 0.0);
}

// A wash passes in half of the half minutes.
TEST(LikeliestPeak, IsNoneWhereItComesAndGoes) {
  const AccelerationSpectra wash = Drawn(21, 7, [](std::size_t half_minute) -> Spectrum {
    const double variance = half_minute % 2 == 0 ? 0.02 : 0.0;
    return [variance](double f) { return Nominal(f) + Sea(f, variance, 0.3); };
  });
  EXPECT_EQ(PeakOf(wash).gain, 0.0);
}

TEST(LikeliestPeak, IsNoneWithoutHalfMinutes) {
  const SpectralPeak none = PeakOf(Drawn(0, 1, [](std::size_t) { return Nominal; }));
  EXPECT_EQ(none.gain, 0.0);
  EXPECT_EQ(none.squared_amplitudes.norm(), 0.0);
}

}  // namespace
}  // namespace telltale
