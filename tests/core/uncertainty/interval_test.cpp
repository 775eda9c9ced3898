#include "telltale/core/uncertainty/interval.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// Two-sided critical values of Student's t, NIST/SEMATECH e-Handbook of Statistical Methods,
/// section 1.3.6.7.2, columns 0.975 and 0.95.
TEST(StudentInterval, AgreesWithThePublishedTable) {
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 1.0, 0.95).upper, 12.706, 5e-4);
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 10.0, 0.95).upper, 2.228, 5e-4);
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 30.0, 0.95).upper, 2.042, 5e-4);
  EXPECT_NEAR(StudentInterval(0.0, 1.0, 10.0, 0.90).upper, 1.812, 5e-4);
}

TEST(StudentInterval, IsCentredAndScalesWithTheStandardError) {
  const Interval interval = StudentInterval(3.0, 0.5, 10.0, 0.95);
  EXPECT_NEAR(interval.lower, 3.0 - 0.5 * 2.228, 3e-4);
  EXPECT_NEAR(interval.upper, 3.0 + 0.5 * 2.228, 3e-4);
  EXPECT_DOUBLE_EQ(interval.level, 0.95);
}

/// Hyndman and Fan type 7 by hand: of 0..40 the position of share q is 40 q.
TEST(PercentileInterval, InterpolatesBetweenOrderStatistics) {
  std::vector<double> replicates;
  for (int i = 40; i >= 0; --i) replicates.push_back(i * i);
  const Interval interval = PercentileInterval(replicates, 0.95);
  EXPECT_NEAR(interval.lower, 1.0, 1e-9);          // position 1 -> 1
  EXPECT_NEAR(interval.upper, 39.0 * 39.0, 1e-9);  // position 39
  const Interval wide = PercentileInterval(replicates, 0.9625);
  EXPECT_NEAR(wide.lower, 0.75, 1e-9);  // position 0.75 between 0 and 1
}

TEST(PercentileInterval, NeedsTwoReplicates) {
  EXPECT_THROW(PercentileInterval(std::vector<double>{1.0}, 0.95), ContractViolation);
}

/// By hand: t* = (replicate - 10) / error is -2, -1, 0, 1, 4; its median half from position 1 to 3
/// is [-1, 1], mirrored and scaled by 0.5.
TEST(StudentizedInterval, MirrorsTheQuantilesOfT) {
  const std::vector<double> replicates = {8.0, 9.0, 10.0, 11.0, 12.0};
  const std::vector<double> errors = {1.0, 1.0, 1.0, 1.0, 0.5};
  const Interval half = StudentizedInterval(10.0, 0.5, replicates, errors, 0.5);
  EXPECT_NEAR(half.lower, 9.5, 1e-12);
  EXPECT_NEAR(half.upper, 10.5, 1e-12);
  const Interval whole = StudentizedInterval(10.0, 0.5, replicates, errors, 1.0);
  EXPECT_NEAR(whole.lower, 8.0, 1e-12);   // 10 - 4 * 0.5: the long upper tail of t reaches down
  EXPECT_NEAR(whole.upper, 11.0, 1e-12);  // 10 + 2 * 0.5
}

std::vector<double> NormalReplicates(std::size_t count) {
  RandomEngine engine(3);
  boost::random::normal_distribution<double> normal(1.0, 0.2);
  std::vector<double> replicates(count);
  for (double& replicate : replicates) replicate = normal(engine);
  return replicates;
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

TEST(BcaInterval, IsThePercentileIntervalWithoutBiasAndAcceleration) {
  const std::vector<double> replicates = NormalReplicates(2000);
  const Interval percentile = PercentileInterval(replicates, 0.95);
  const Interval bca = BcaInterval(Median(replicates), 0.0, replicates, 0.95);
  EXPECT_NEAR(bca.lower, percentile.lower, 1e-9);
  EXPECT_NEAR(bca.upper, percentile.upper, 1e-9);
}

/// A monotone change of scale carries the interval along. Interpolation between neighbours among
/// 100,000 replicates is all that is not monotone about it.
TEST(BcaInterval, FollowsAMonotoneChangeOfScale) {
  const std::vector<double> replicates = NormalReplicates(100000);
  std::vector<double> mapped = replicates;
  for (double& value : mapped) value = std::exp(3.0 * value);
  const Interval plain = BcaInterval(1.05, 0.1, replicates, 0.95);
  const Interval image = BcaInterval(std::exp(3.0 * 1.05), 0.1, mapped, 0.95);
  EXPECT_NEAR(std::log(image.lower) / 3.0, plain.lower, 1e-4);
  EXPECT_NEAR(std::log(image.upper) / 3.0, plain.upper, 1e-4);
  const Interval symmetric = PercentileInterval(replicates, 0.95);
  EXPECT_GT(plain.lower, symmetric.lower + 0.05);  // both corrections move it up
  EXPECT_GT(plain.upper, symmetric.upper + 0.05);
}

TEST(BcaInterval, StaysAmongTheReplicatesWhenTheEstimateLiesOutside) {
  const std::vector<double> replicates = NormalReplicates(200);
  for (const double estimate : {-100.0, 100.0}) {
    const Interval interval = BcaInterval(estimate, 0.4, replicates, 0.95);
    EXPECT_GE(interval.lower, *std::min_element(replicates.begin(), replicates.end()));
    EXPECT_LE(interval.upper, *std::max_element(replicates.begin(), replicates.end()));
    EXPECT_LE(interval.lower, interval.upper);
  }
}

/// Efron and Tibshirani (1993), chapter 14: the variance of the spatial test
/// data A, 171.5, has the acceleration 0.061.
TEST(JackknifeAcceleration, AgreesWithThePublishedExample) {
  const std::vector<double> scores = {48, 36, 20, 29, 42, 42, 20, 42, 22, 41, 45, 14, 6,
                                      0,  33, 28, 34, 4,  32, 24, 47, 41, 24, 26, 30, 41};
  const auto variance = [](const std::vector<double>& x) {
    const Eigen::Map<const Eigen::ArrayXd> values(x.data(), static_cast<Eigen::Index>(x.size()));
    return (values - values.mean()).square().mean();
  };
  ASSERT_NEAR(variance(scores), 171.5, 0.05);
  std::vector<double> left_out;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    std::vector<double> rest = scores;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    left_out.push_back(variance(rest));
  }
  EXPECT_NEAR(JackknifeAcceleration(left_out), 0.061, 5e-4);
  EXPECT_EQ(JackknifeAcceleration(std::vector<double>(5, 2.0)), 0.0);
}

TEST(Unbounded, RulesNothingOut) {
  EXPECT_TRUE(std::isinf(Unbounded(0.95).lower));
  EXPECT_TRUE(std::isinf(Unbounded(0.95).upper));
}

// Quantiles of the normal law, from any table: 1.959964 at 0.975, 1.644854 at 0.95.
TEST(NormalInterval, HoldsTabulatedQuantiles) {
  const Interval wide = NormalInterval(3.0, 2.0, 0.95);
  EXPECT_EQ(wide.level, 0.95);
  EXPECT_NEAR(wide.lower, 3.0 - 2.0 * 1.959964, 1e-6);
  EXPECT_NEAR(wide.upper, 3.0 + 2.0 * 1.959964, 1e-6);
  EXPECT_NEAR(NormalInterval(0.0, 1.0, 0.9).upper, 1.644854, 1e-6);
  EXPECT_EQ(NormalInterval(3.0, 0.0, 0.95).upper, 3.0);
  EXPECT_TRUE(std::isinf(NormalInterval(3.0, std::numeric_limits<double>::infinity(), 0.95).lower));
}

}  // namespace
}  // namespace telltale
