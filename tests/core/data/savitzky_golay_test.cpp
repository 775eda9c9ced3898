#include "telltale/core/data/savitzky_golay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

double Power(double s, std::size_t degree) {
  return std::pow(s, static_cast<double>(degree));
}

// Table I of Savitzky and Golay (1964), quadratic or cubic, five and seven points.
TEST(SavitzkyGolay, GivesThePublishedSmoothingWeights) {
  const auto five = SavitzkyGolay(2, 3).ValueWeights(2);
  const double truth5[] = {-3, 12, 17, 12, -3};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(five(i), truth5[i] / 35.0, 1e-14);
  const auto seven = SavitzkyGolay(3, 2).ValueWeights(3);
  const double truth7[] = {-2, 3, 6, 7, 6, 3, -2};
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(seven(i), truth7[i] / 21.0, 1e-14);
}

// Its tables of first derivatives: quadratic, and cubic or quartic, five points.
TEST(SavitzkyGolay, GivesThePublishedSlopeWeights) {
  const auto quadratic = SavitzkyGolay(2, 2).SlopeWeights(2);
  const double truth2[] = {-2, -1, 0, 1, 2};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(quadratic(i), truth2[i] / 10.0, 1e-14);
  const auto cubic = SavitzkyGolay(2, 3).SlopeWeights(2);
  const double truth3[] = {1, -8, 0, 8, -1};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(cubic(i), truth3[i] / 12.0, 1e-14);
}

TEST(SavitzkyGolay, IsExactOnPolynomialsUpToItsDegreeEndsIncluded) {
  for (std::size_t half_width = 2; half_width <= 12; half_width += 5) {
    for (std::size_t degree = 1; degree <= 4; ++degree) {
      const SavitzkyGolay filter(half_width, degree);
      std::vector<double> series;
      std::vector<double> slope;
      for (int i = 0; i < 40; ++i) {
        const double s = (i - 20) / 20.0;
        series.push_back(Power(s, degree) - 2.0 * s);
        slope.push_back((static_cast<double>(degree) * Power(s, degree - 1) - 2.0) / 20.0);
      }
      const auto smooth = filter.Smooth(series);
      const auto derived = filter.Slope(series);
      for (std::size_t i = 0; i < series.size(); ++i) {
        // Round-off through the pseudo-inverse of a window of degree four.
        ASSERT_NEAR(smooth[i], series[i], 1e-11);
        ASSERT_NEAR(derived[i], slope[i], 1e-11);
      }
    }
  }
}

TEST(SavitzkyGolay, SlopeIsTheSameFromIncrements) {
  const SavitzkyGolay filter(4, 3);
  std::vector<double> series;
  for (int i = 0; i < 30; ++i) series.push_back(std::sin(0.7 * i) + 0.1 * i * (i % 3));
  std::vector<double> increments;
  for (std::size_t i = 1; i < series.size(); ++i) increments.push_back(series[i] - series[i - 1]);
  const auto slope = filter.Slope(series);
  const auto again = filter.SlopeOfIncrements(increments);
  ASSERT_EQ(again.size(), series.size());
  for (std::size_t i = 0; i < series.size(); ++i) EXPECT_NEAR(again[i], slope[i], 1e-12);
}

TEST(SavitzkyGolay, IncrementWeightsSumToOneAnywhereInTheWindow) {
  const SavitzkyGolay filter(5, 3);
  for (std::size_t position = 0; position < filter.WindowLength(); ++position) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < filter.WindowLength(); ++i) {
      sum += filter.IncrementWeight(position, i);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(SavitzkyGolay, RequiresAWindowThatHoldsTheDegreeAndASeriesThatHoldsTheWindow) {
  EXPECT_THROW(SavitzkyGolay(2, 5), ContractViolation);
  EXPECT_THROW(SavitzkyGolay(2, 2).Smooth(std::vector<double>(4, 1.0)), ContractViolation);
}

}  // namespace
}  // namespace telltale
