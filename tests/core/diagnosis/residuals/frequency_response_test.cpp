#include "telltale/core/diagnosis/residuals/frequency_response.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/resting_boat.hpp"

namespace telltale {
namespace {

/// The block of a channel among the response moments.
Eigen::MatrixXd BlockOf(const Eigen::MatrixXd& moments, Eigen::Index channel) {
  const auto rows = Eigen::seq(channel, Eigen::last, 3);
  return moments(rows, rows);
}

class RespondingBoat : public ::testing::TestWithParam<double> {
 protected:
  ResponseMoments Moments() const {
    const AugmentedModel alone{boat_.model, {}};
    return ResponseMomentsAt(GetParam(), boat_.runs, alone, boat_.runs.Errors(alone));
  }

  testing::RestingBoat boat_;
};

// cos(w t + phase) integrates to -cos(w t + phase) / w^2 and a straight line, which the start
// takes. The mean over the phases is half the sum of the outer products of cos and sin.
TEST_P(RespondingBoat, MovesAsTheSecondIntegralOfTheAcceleration) {
  const double w = GetParam();
  const ResponseMoments moments = Moments();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(boat_.runs.Rows() / 3, boat_.runs.Rows() / 3);
    for (std::size_t window = 0; window < boat_.runs.Windows(); ++window) {
      const Eigen::VectorXd cosine =
          boat_.LeftByTheStart(window, axis, [&](double t) { return std::cos(w * t); });
      const Eigen::VectorXd sine =
          boat_.LeftByTheStart(window, axis, [&](double t) { return std::sin(w * t); });
      expected += (cosine * cosine.transpose() + sine * sine.transpose()) /
                  (2.0 * std::pow(w, 4) * static_cast<double>(boat_.runs.Windows()));
    }
    const Eigen::MatrixXd found = BlockOf(moments[static_cast<std::size_t>(axis)], axis);
    const double step = w * boat_.dataset.sampling_period_s;
    EXPECT_LT((found - expected).norm(), step * step / 5.0 * expected.norm()) << "axis " << axis;
  }
}

TEST_P(RespondingBoat, RespondsInTheChannelOfTheAxisAlone) {
  const ResponseMoments moments = Moments();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd& all = moments[static_cast<std::size_t>(axis)];
    EXPECT_LT(all.squaredNorm() - BlockOf(all, axis).squaredNorm(), 1e-9 * all.squaredNorm());
  }
}

INSTANTIATE_TEST_SUITE_P(RadiansPerSecond, RespondingBoat, ::testing::Values(0.8, 1.5, 3.0));

/// The mean of the response over a log-normal law of frequency, by the trapezoidal rule.
ResponseMoments MeanOverPeak(double frequency_rad_s, double log_width,
                             const testing::RestingBoat& boat) {
  const AugmentedModel alone{boat.model, {}};
  const Eigen::MatrixXd errors = boat.runs.Errors(alone);
  ResponseMoments mean;
  mean.fill(Eigen::MatrixXd::Zero(errors.rows(), errors.rows()));
  constexpr double kStep = 0.25;
  for (double x = -4.0; x <= 4.0; x += kStep) {
    const double weight = kStep * std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
    const ResponseMoments at =
        ResponseMomentsAt(frequency_rad_s * std::exp(log_width * x), boat.runs, alone, errors);
    for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += weight * at[axis];
  }
  return mean;
}

// Five nodes of Gauss and Hermite integrate a response that falls with the fourth power of the
// frequency to a few percent.
TEST(ErrorCovarianceBy, IsTheMeanResponseOverThePeakTimesSquaredAmplitudes) {
  const testing::RestingBoat boat;
  const AugmentedModel alone{boat.model, {}};
  SpectralPeak peak;
  peak.frequency_rad_s = 2.5;
  peak.squared_amplitudes << 0.04, 0.09, 0.01;
  peak.log_width = 0.3;
  const ResponseMoments mean = MeanOverPeak(peak.frequency_rad_s, peak.log_width, boat);
  const Eigen::MatrixXd expected = 0.04 * mean[0] + 0.09 * mean[1] + 0.01 * mean[2];
  const Eigen::MatrixXd found =
      ErrorCovarianceBy(MeanResponseMomentsOf(peak.frequency_rad_s, peak.log_width, boat.runs,
                                              alone, boat.runs.Errors(alone)),
                        peak.squared_amplitudes);
  EXPECT_LT((found - expected).norm(), 0.05 * expected.norm());
}

}  // namespace
}  // namespace telltale
