#include "telltale/core/uncertainty/interval_calibration.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/uncertainty/distributions.hpp"
#include "telltale/core/uncertainty/joint_bounds.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kUnknowns = 10;
constexpr double kDegreesOfFreedom = 30.0;
const std::vector<Block> kBlocks = {{0, 1}, {1, 4}, {5, 5}};

/// A law of estimates that is known: a bias, another scatter along each whitened direction, and
/// clusters that tell the covariance as well as so many normal observations do, of a wrong `size`.
class KnownDistribution {
 public:
  KnownDistribution(double size, std::uint64_t seed) : size_(size), engine_(seed) {}

  ReplicateError Draw() {
    ReplicateError replicate_error{Eigen::VectorXd(kUnknowns),
                                   Eigen::MatrixXd::Zero(kUnknowns, kUnknowns)};
    for (Eigen::Index j = 0; j < kUnknowns; ++j) {
      replicate_error.error[j] = (Bias(j) + Scatter(j) * normal_(engine_)) / std::sqrt(size_);
    }
    for (int look = 0; look < static_cast<int>(kDegreesOfFreedom); ++look) {
      Eigen::VectorXd x(kUnknowns);
      for (double& value : x) value = normal_(engine_);
      replicate_error.covariance += x * x.transpose() / kDegreesOfFreedom;
    }
    return replicate_error;
  }

  std::vector<ReplicateError> Draw(int parametric_replicates) {
    std::vector<ReplicateError> all;
    for (int i = 0; i < parametric_replicates; ++i) all.push_back(Draw());
    return all;
  }

  static double Bias(Eigen::Index j) { return j == 2 ? 1.0 : 0.0; }
  static double Scatter(Eigen::Index j) { return 0.5 + 0.2 * static_cast<double>(j); }

 private:
  double size_;
  RandomEngine engine_;
  boost::random::normal_distribution<double> normal_;
};

/// Unknowns of a block are combinations of its whitened directions.
Eigen::MatrixXd Map() {
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
  for (const auto& [begin, size] : kBlocks) {
    for (Eigen::Index i = 0; i < size; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) map(begin + i, begin + j) = i == j ? 2.0 : 0.7;
    }
  }
  return map;
}

struct Held {
  double intervals = 0.0;  // percent
  double ellipsoids = 0.0;
};

/// How often bounds from forty replicates hold the truth, an estimate of the same law, over 400
/// repeats: an ellipsoid's share is known to 1.1 points, that of ten intervals together to less.
Held HoldWhereClustersSay(double size) {
  constexpr int kRepeats = 400;
  const double t = StudentQuantile(kDegreesOfFreedom, 0.975);
  Held held;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    KnownDistribution law(size, 7 + static_cast<std::uint64_t>(repeat));
    const std::vector<ReplicateError> parametric_replicates = law.Draw(40);
    const auto calibration =
        CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom);
    const ReplicateError estimate = law.Draw();
    const Eigen::VectorXd off = Map() * estimate.error - calibration->bias;
    const Eigen::MatrixXd covariance =
        calibration->scale * estimate.covariance * calibration->scale.transpose();
    const Eigen::ArrayXd sizes =
        calibration->interval_factors.array() * covariance.diagonal().array().sqrt();
    const auto within = (off.array().abs() <= t * sizes).count();
    held.intervals += 100.0 * static_cast<double>(within) / kUnknowns / kRepeats;
    const double square = off.dot(covariance.ldlt().solve(off));
    const JointBounds joint{calibration->covariance_factor, kDegreesOfFreedom};
    if (square <= SquaredRadius(joint, kUnknowns, 0.95)) held.ellipsoids += 100.0 / kRepeats;
  }
  return held;
}

/// Three standard errors of the shares to either side of 95.
TEST(IntervalCalibration, BoundsHoldWhereTheTruthIsAnotherReplicate) {
  const Held held = HoldWhereClustersSay(1.0);
  EXPECT_NEAR(held.intervals, 95.0, 1.5);
  EXPECT_NEAR(held.ellipsoids, 95.0, 3.3);
}

TEST(IntervalCalibration, InflatesWhatHoldsTooSeldom) {
  const Held held = HoldWhereClustersSay(1.0 / 3.0);
  EXPECT_NEAR(held.intervals, 95.0, 1.5);
  EXPECT_NEAR(held.ellipsoids, 95.0, 3.3);
}

/// Intervals 1.7 times as wide as they need be would hold 99.9 %.
TEST(IntervalCalibration, ShrinksWhatHoldsTooOften) {
  const Held held = HoldWhereClustersSay(3.0);
  EXPECT_NEAR(held.intervals, 95.0, 1.5);
  EXPECT_NEAR(held.ellipsoids, 95.0, 3.3);
}

/// One direction errs by anything up to a limit and never beyond: what its spread and Student say
/// lies outside all of it. Its unknown is no combination of others.
TEST(IntervalCalibration, HoldsAnUnknownOfAnotherTailToo) {
  constexpr int kRepeats = 400;
  constexpr Eigen::Index kUnlike = 5;
  const double t = StudentQuantile(kDegreesOfFreedom, 0.975);
  double by_factor = 0.0;
  double by_student = 0.0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    KnownDistribution law(1.0, 1000 + static_cast<std::uint64_t>(repeat));
    std::vector<ReplicateError> all = law.Draw(41);
    for (ReplicateError& replicate_error : all) {
      const double drawn = replicate_error.error[kUnlike] / KnownDistribution::Scatter(kUnlike);
      replicate_error.error[kUnlike] = 1.0 - 2.0 * NormalTail(drawn);
      replicate_error.covariance = Eigen::MatrixXd::Identity(kUnknowns, kUnknowns);
    }
    const ReplicateError estimate = all.back();
    all.pop_back();
    const auto calibration = CalibrateIntervals(all, Map(), kBlocks, kDegreesOfFreedom);
    const double off = (Map() * estimate.error - calibration->bias)[kUnlike];
    const Eigen::MatrixXd covariance = calibration->scale * calibration->scale.transpose();
    const double reach = t * std::sqrt(covariance(kUnlike, kUnlike));
    by_student += std::abs(off) <= reach ? 100.0 / kRepeats : 0.0;
    by_factor +=
        std::abs(off) <= calibration->interval_factors[kUnlike] * reach ? 100.0 / kRepeats : 0.0;
  }
  EXPECT_GT(by_student, 97.0);        // clearly more than was promised
  EXPECT_NEAR(by_factor, 95.0, 3.3);  // three standard errors of the share
}

TEST(IntervalCalibration, LetsNoIntervalShrinkByTooFewReplicates) {
  KnownDistribution law(1.0, 29);
  const auto calibration = CalibrateIntervals(law.Draw(18), Map(), kBlocks, kDegreesOfFreedom);
  EXPECT_GE(calibration->interval_factors.minCoeff(), 1.0);
}

/// A quarter of the replicates err six times as far, and their clusters say so. Scatters that did
/// not heed that would be sqrt(0.75 + 0.25 36) = 3.1 times those of a twin that knows its boat;
/// what is left are few draws, known to a quarter of themselves at two standard errors.
TEST(IntervalCalibration, AReplicateOfLargeStandardErrorIsNoOutlier) {
  KnownDistribution law(1.0, 23);
  std::vector<ReplicateError> parametric_replicates = law.Draw(40);
  const auto before = CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom);
  for (std::size_t i = 0; i < parametric_replicates.size(); i += 4) {
    parametric_replicates[i].error *= 6.0;
    parametric_replicates[i].covariance *= 36.0;
  }
  const auto after = CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom);
  for (Eigen::Index j = 0; j < kUnknowns; ++j) {
    EXPECT_NEAR(after->scale(j, j), before->scale(j, j), 0.4 * before->scale(j, j)) << j;
  }
}

/// The mean of forty draws is known to their scatter over sqrt(40), four times which none of ten
/// leaves; scatters add up as squares in a combination.
TEST(IntervalCalibration, EstimatesTheBias) {
  KnownDistribution law(1.0, 11);
  const std::vector<ReplicateError> parametric_replicates = law.Draw(40);
  const auto calibration =
      CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom);
  Eigen::VectorXd bias(kUnknowns);
  Eigen::VectorXd variances(kUnknowns);
  for (Eigen::Index j = 0; j < kUnknowns; ++j) {
    bias[j] = KnownDistribution::Bias(j);
    variances[j] = KnownDistribution::Scatter(j) * KnownDistribution::Scatter(j);
  }
  const Eigen::VectorXd expected = Map() * bias;
  const Eigen::VectorXd scatter = (Map().cwiseAbs2() * variances).cwiseSqrt();
  for (Eigen::Index j = 0; j < kUnknowns; ++j) {
    EXPECT_NEAR(calibration->bias[j], expected[j], 4.0 * scatter[j] / std::sqrt(40.0)) << j;
  }
}

/// One twin in forty that is a hundred times as far off as it was counts as four standard errors
/// off. Unheeded it would make sizes sixteen times as large.
TEST(IntervalCalibration, IsRobustToAnOutlyingReplicate) {
  KnownDistribution law(1.0, 13);
  std::vector<ReplicateError> parametric_replicates = law.Draw(40);
  const auto before = CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom);
  parametric_replicates[5].error *= 100.0;
  const auto after = CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom);
  for (Eigen::Index j = 0; j < kUnknowns; ++j) {
    EXPECT_LT(after->scale(j, j), 1.5 * before->scale(j, j)) << j;
  }
}

TEST(IntervalCalibration, IsNoneWhereNumbersOverflow) {
  KnownDistribution law(1.0, 17);
  std::vector<ReplicateError> parametric_replicates = law.Draw(8);
  for (ReplicateError& twin : parametric_replicates)
    twin.error *= std::numeric_limits<double>::max() / 4.0;
  EXPECT_FALSE(CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom));
}

TEST(IntervalCalibration, OfTwoReplicatesIsABrokenContract) {
  KnownDistribution law(1.0, 19);
  const std::vector<ReplicateError> parametric_replicates = law.Draw(2);
  EXPECT_THROW(CalibrateIntervals(parametric_replicates, Map(), kBlocks, kDegreesOfFreedom),
               ContractViolation);
}

TEST(ReplicateError, IsUnsoundWithoutVariances) {
  ReplicateError replicate_error{Eigen::VectorXd::Ones(2), Eigen::MatrixXd::Identity(2, 2)};
  EXPECT_TRUE(IsUsable(replicate_error));
  replicate_error.covariance(1, 1) = 0.0;
  EXPECT_FALSE(IsUsable(replicate_error));
}

}  // namespace
}  // namespace telltale
