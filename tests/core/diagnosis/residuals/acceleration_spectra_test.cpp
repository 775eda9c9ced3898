#include "telltale/core/diagnosis/residuals/acceleration_spectra.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <boost/random/exponential_distribution.hpp>

#include "support/resting_boat.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

using std::numbers::pi;

/// A boat that nothing drives and that surges in simple harmonic motion along its heading: its
/// acceleration is a cosine, of which nothing is explained.
class SurgingBoat : public ::testing::TestWithParam<double> {
 protected:
  static constexpr double kAcceleration = 0.3;  // m/s^2
  static constexpr double kDurationS = 122.0;

  AccelerationSpectra Spectra() const {
    const double rate = 2.0 * pi * GetParam();
    std::vector<TimedState> track;
    for (int i = 0; 0.02 * i <= kDurationS; ++i) {
      TimedState at;
      at.time_s = 0.02 * i;
      at.state.eta.x_m = -kAcceleration / (rate * rate) * std::cos(rate * at.time_s);
      at.state.nu.u = kAcceleration / rate * std::sin(rate * at.time_s);
      track.push_back(at);
    }
    PrepareOptions options;
    options.sampling_period_s = 0.2;
    const PreparedDataset dataset =
        Prepare(Measure(track, Vehicle{}, testing::NoNoise()), Vehicle{}, options).value();
    return AccelerationSpectraOf(dataset, {boat_.model, {}});
  }

  testing::RestingBoat boat_;
};

// The power of a cosine is half its squared amplitude, times what the filter leaves of it. Hann's
// taper spreads it over neighbouring frequencies, which the sum collects.
TEST_P(SurgingBoat, HasThePowerThatTheFilterLeaves) {
  const AccelerationSpectra spectra = Spectra();
  ASSERT_EQ(spectra.half_minutes.size(), 4U);
  const Eigen::Index harmonic =
      static_cast<Eigen::Index>(std::lround(GetParam() * 30.0)) -
      static_cast<Eigen::Index>(std::lround(spectra.frequencies_hz[0] * 30.0));
  const double left = 0.5 * kAcceleration * kAcceleration * spectra.power_gains[harmonic];
  // The first and last half minutes have ends of the series, which are filtered otherwise.
  const double power = spectra.half_minutes[1][0].sum() / 30.0;
  EXPECT_NEAR(power, left, 0.03 * left);
  EXPECT_LT(spectra.half_minutes[1][1].sum(), 1e-6 * spectra.half_minutes[1][0].sum());
  EXPECT_LT(spectra.half_minutes[1][2].sum(), 1e-6 * spectra.half_minutes[1][0].sum());
}

INSTANTIATE_TEST_SUITE_P(Hertz, SurgingBoat, ::testing::Values(0.2, 0.4, 0.7));

TEST(AccelerationSpectra, PassSlowAccelerationsWhole) {
  const testing::RestingBoat boat;
  const AccelerationSpectra spectra = AccelerationSpectraOf(boat.dataset, {boat.model, {}});
  EXPECT_NEAR(spectra.power_gains[0], 1.0, 0.01);
  EXPECT_LT(spectra.power_gains.maxCoeff(), 1.0);
}

// Fixes once a second: 0.5 Hz is the highest frequency that they tell from a lower one.
TEST(AccelerationSpectra, SeeNothingBeyondHalfTheSamplingRate) {
  const testing::RestingBoat boat;
  PreparedDataset slow = boat.dataset;
  slow.signals.clear();
  slow.sampling_period_s = 1.0;
  const AccelerationSpectra spectra = AccelerationSpectraOf(slow, {boat.model, {}});
  for (Eigen::Index i = 0; i < spectra.frequencies_hz.size(); ++i) {
    if (spectra.frequencies_hz[i] > 0.5) {
      EXPECT_EQ(spectra.power_gains[i], 0.0);
    }
  }
}

// Of 4000 draws the mean is known to 2 %.
TEST(QuantileSpectrum, IsUnbiasedForExponentialVariables) {
  RandomEngine engine(3);
  boost::random::exponential_distribution<double> exponential;
  for (const std::size_t half_minutes : {1U, 2U, 5U, 20U}) {
    double mean = 0.0;
    constexpr int kDraws = 4000;
    for (int draw = 0; draw < kDraws; ++draw) {
      std::vector<std::array<Eigen::ArrayXd, 3>> powers(half_minutes);
      for (auto& axes : powers) axes.fill(Eigen::ArrayXd::Constant(1, exponential(engine)));
      mean += QuantileSpectrum(powers)[0][0] / kDraws;
    }
    EXPECT_NEAR(mean, 1.0, 0.05) << half_minutes;
  }
}

TEST(QuantileSpectrum, ForgetsWhatComesInFewHalfMinutes) {
  std::vector<std::array<Eigen::ArrayXd, 3>> powers(20);
  for (std::size_t k = 0; k < powers.size(); ++k) {
    powers[k].fill(Eigen::ArrayXd::Constant(1, k % 2 == 0 ? 1000.0 : 1.0));
  }
  EXPECT_LT(QuantileSpectrum(powers)[1][0], 2.0);
}

}  // namespace
}  // namespace telltale
