#include "telltale/core/diagnosis/residuals/frequency_response.hpp"

#include <cmath>

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

TEST(FrequencyResponse, HoldsTheRangeOfEachStochasticEffectAtEvenRatios) {
  const testing::RestingBoat boat;
  const AugmentedModel alone{boat.model, {}};
  const Effect* const waves = FindEffect("waves");
  const std::vector<const Effect*> library = {FindEffect("current"), waves};
  const FrequencyResponse response(library, boat.runs, alone, boat.runs.Errors(alone), 1);
  const auto& bands = response.Of(*waves);
  ASSERT_GT(bands.size(), 2U);
  const EffectParameter frequency = waves->Parameters()[3];
  EXPECT_DOUBLE_EQ(bands.front().frequency_rad_s, frequency.lower);
  EXPECT_NEAR(bands.back().frequency_rad_s, frequency.upper, 1e-12 * frequency.upper);
  const double ratio = bands[1].frequency_rad_s / bands[0].frequency_rad_s;
  for (std::size_t i = 1; i < bands.size(); ++i) {
    EXPECT_NEAR(bands[i].frequency_rad_s / bands[i - 1].frequency_rad_s, ratio, 1e-9);
  }
}

}  // namespace
}  // namespace telltale
