#include "telltale/core/data/time_series.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

TimeSeries SampleUnevenly(int count, const std::function<double(double)>& value_at) {
  TimeSeries series;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i + 0.03 * std::sin(5.0 * i);
    series.times_s.push_back(t);
    series.values.push_back(value_at(t));
  }
  return series;
}

double Polynomial(double t, std::size_t degree) {
  double value = 0.0;
  for (std::size_t p = 0; p <= degree; ++p) value = value * t + 1.0 / static_cast<double>(p + 1);
  return value;
}

// Samples at 0, 1, ..., 9.
TEST(Within, TakesTheBeginningAndLeavesTheEnd) {
  TimeSeries series;
  for (int i = 0; i < 10; ++i) {
    series.times_s.push_back(i);
    series.values.push_back(10.0 * i);
  }
  const TimeSeries part = series.Within(2.0, 5.0);
  EXPECT_EQ(part.times_s, (std::vector{2.0, 3.0, 4.0}));
  EXPECT_EQ(part.values, (std::vector{20.0, 30.0, 40.0}));
  EXPECT_EQ(series.Within(5.0, 9.5).times_s.front(), 5.0);
  EXPECT_EQ(series.Within(-1.0, 20.0).times_s.size(), 10u);
  EXPECT_TRUE(series.Within(2.5, 2.9).times_s.empty());
}

TEST(Extrapolate, IsExactOnPolynomialsUpToItsDegree) {
  for (const std::size_t degree : {1u, 3u, 8u}) {
    const TimeSeries series = SampleUnevenly(20, [&](double t) { return Polynomial(t, degree); });
    for (const double t : {1.1, 1.55, 1.99}) {
      // Round-off times the sum of the weights' sizes, at most 2^9 a period ahead.
      EXPECT_NEAR(series.Extrapolate(t, degree), Polynomial(t, degree), 1e-9);
    }
  }
}

TEST(Extrapolate, IsCausal) {
  TimeSeries series = SampleUnevenly(20, [](double t) { return std::sin(t); });
  const double before = series.Extrapolate(1.0, 3);
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    if (series.times_s[i] > 1.0) series.values[i] = 1e6;
  }
  EXPECT_EQ(series.Extrapolate(1.0, 3), before);
}

TEST(Extrapolate, HitsASampleOfTheSameInstant) {
  const TimeSeries series{{0.0, 0.2, 0.4, 0.6, 0.8}, {5, 1, 4, 2, 3}};
  EXPECT_DOUBLE_EQ(series.Extrapolate(0.6, 3), 2.0);
  EXPECT_NEAR(series.Extrapolate(3 * 0.2, 3), 2.0, 1e-12) << "3 * 0.2 is not 0.6 in binary";
}

TEST(Extrapolate, UsesFewerSamplesAtTheStart) {
  const TimeSeries series{{0.0, 1.0, 2.0}, {1.0, 3.0, 100.0}};
  EXPECT_DOUBLE_EQ(series.Extrapolate(0.5, 3), 1.0);
  EXPECT_DOUBLE_EQ(series.Extrapolate(1.5, 3), 4.0);
  EXPECT_THROW(series.Extrapolate(-0.1, 3), ContractViolation);
}

TEST(Interpolate, IsExactOnCubicsInside) {
  const TimeSeries series = SampleUnevenly(20, [](double t) { return Polynomial(t, 3); });
  for (double t = 0.25; t < 1.7; t += 0.01) {
    EXPECT_NEAR(series.Interpolate(t), Polynomial(t, 3), 1e-12);
  }
}

TEST(Interpolate, StaysBoundedWhereStampsAreUneven) {
  // Two samples 1 ms apart with 1 cm of noise between them, next to an interval of 1 s.
  const TimeSeries series{{0.0, 1.0, 2.0, 2.001, 3.0}, {0.0, 0.0, 0.0, 0.01, 0.0}};
  for (double t = 1.0; t < 2.0; t += 0.05) EXPECT_LT(std::abs(series.Interpolate(t)), 0.01);
}

TEST(Interpolate, HoldsBeyondTheEnds) {
  const TimeSeries series{{0.0, 1.0, 2.0}, {1.0, 3.0, 7.0}};
  EXPECT_EQ(series.Interpolate(-1.0), 1.0);
  EXPECT_EQ(series.Interpolate(5.0), 7.0);
}

TEST(MeanAbout, IsTheMeanOfTheLinearInterpolation) {
  const TimeSeries series{{0.0, 1.0, 2.0, 3.0}, {0.0, 2.0, 0.0, 0.0}};
  EXPECT_DOUBLE_EQ(series.MeanAbout(1.0, 2.0), 1.0);  // a triangle of height 2 over its base
  EXPECT_DOUBLE_EQ(series.MeanAbout(1.0, 1.0), 1.5);
  EXPECT_DOUBLE_EQ(series.MeanAbout(0.0, 1.0), 0.0);
}

TEST(MeanAbout, KeepsStraightLinesEndsIncluded) {
  const TimeSeries series = SampleUnevenly(30, [](double t) { return 3.0 - 2.0 * t; });
  for (double t = 0.0; t < 2.8; t += 0.07) EXPECT_NEAR(series.MeanAbout(t, 0.5), 3 - 2 * t, 1e-12);
}

}  // namespace
}  // namespace telltale
