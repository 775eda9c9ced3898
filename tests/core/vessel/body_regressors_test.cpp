#include "telltale/core/vessel/body_regressors.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

namespace telltale {
namespace {

/// The average of f over a standard normal variable, by quadrature.
double OverNormal(const std::function<double(double)>& f) {
  constexpr double kStep = 0.001;
  double sum = 0.0;
  for (double z = -8.0; z <= 8.0; z += kStep) {
    sum += kStep * std::exp(-0.5 * z * z) * f(z);
  }
  return sum * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

constexpr double kNoise = 0.1;

/// What noise adds to a regressor of v on average: as measured, and with the correction.
struct Biases {
  double measured = 0.0;
  double corrected = 0.0;
};

Biases BiasesAt(double v, std::size_t regressor) {
  const Nu noise{0.0, kNoise, 0.0};
  const auto at = [&](double z) { return Nu{0.7, v + kNoise * z, 0.4}; };
  const double truth = BodyRowAt(at(0.0)).turning[regressor];
  return {OverNormal([&](double z) { return BodyRowAt(at(z)).turning[regressor]; }) - truth,
          OverNormal([&](double z) {
            return NoiseCorrectedBodyRow(at(z), noise).turning[regressor];
          }) - truth};
}

constexpr std::size_t kSquare = 0;  // v |v|
constexpr std::size_t kSize = 2;    // r |v|

TEST(NoiseCorrectedBodyRow, IsTheRowItselfWithoutNoise) {
  const Nu nu{0.7, -0.2, 0.4};
  const BodyRow measured = BodyRowAt(nu);
  const BodyRow corrected = NoiseCorrectedBodyRow(nu, {});
  EXPECT_EQ(corrected.surge, measured.surge);
  EXPECT_EQ(corrected.turning, measured.turning);
}

TEST(NoiseCorrectedBodyRow, IsUnbiasedAwayFromZero) {
  for (const double v : {-0.6, 0.5, 1.0}) {
    const Biases square = BiasesAt(v, kSquare);
    EXPECT_NEAR(square.measured, std::copysign(kNoise * kNoise, v), 1e-6);
    EXPECT_NEAR(square.corrected, 0.0, 1e-4 * kNoise * kNoise);
  }
}

/// The largest of the biases of a regressor over velocities about and beyond the bend.
Biases WorstOf(std::size_t regressor) {
  Biases worst;
  for (double v = 0.0; v < 5.0 * kNoise; v += 0.1 * kNoise) {
    const Biases here = BiasesAt(v, regressor);
    worst.measured = std::max(worst.measured, std::abs(here.measured));
    worst.corrected = std::max(worst.corrected, std::abs(here.corrected));
  }
  return worst;
}

// At the bend itself |x| is off by sqrt(2 / pi) sigma, and 2 - sqrt 2 of that with the correction,
// whose second order is left.
TEST(NoiseCorrectedBodyRow, IsLessBiasedAtZeroToo) {
  const Biases size = WorstOf(kSize);
  EXPECT_NEAR(size.measured, 0.4 * kNoise * std::sqrt(2.0 / std::numbers::pi), 1e-6);
  EXPECT_NEAR(size.corrected, (2.0 - std::numbers::sqrt2) * size.measured, 1e-6);
  const Biases square = WorstOf(kSquare);
  EXPECT_LT(square.corrected, 0.5 * square.measured);
}

TEST(NoiseCorrectedBodyRow, SubtractsTheVarianceFromASquare) {
  const Nu noise{0.0, 0.0, 0.05};
  const double mean = OverNormal([&](double z) {
    return NoiseCorrectedBodyRow({0.7, 0.1, 0.3 + noise.r * z}, noise).surge[2];
  });
  EXPECT_NEAR(mean, 0.3 * 0.3, 1e-9);
}

TEST(NoiseCorrectedBodyRow, KeepsProductsOfIndependentVelocities) {
  const Nu nu{0.7, -0.2, 0.4};
  const BodyRow measured = BodyRowAt(nu);
  const BodyRow corrected = NoiseCorrectedBodyRow(nu, {0.1, 0.1, 0.1});
  for (const std::size_t i : {1, 3, 4}) EXPECT_EQ(corrected.surge[i], measured.surge[i]);
  for (const std::size_t i : {4, 5, 6, 7, 8}) EXPECT_EQ(corrected.turning[i], measured.turning[i]);
}

}  // namespace
}  // namespace telltale
