#include "telltale/core/estimation/output_error/output_error.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/output_error/output_error_covariance.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

PreparedDataset Observe(const std::vector<TimedState>& track, double noise_scale,
                        std::uint64_t seed) {
  const Vehicle vehicle = testing::StableBoatVehicle();
  return Prepare(Measure(track, vehicle, testing::NoisySensors(noise_scale, seed)), vehicle, {})
      .value();
}

RegressionOptions Lagging(bool lagging) {
  RegressionOptions regression;
  if (lagging) regression.structure = Structure::kFirstOrderDynamic;
  return regression;
}

Result<OutputErrorFit> Estimate(const PreparedDataset& dataset, const RegressionOptions& regression,
                                const OutputErrorOptions& options = {}) {
  const auto columns = AllColumns(regression.parameterization);
  return EstimateOutputError(dataset, regression, columns, StartOf(dataset, regression, columns),
                             options);
}

class NoNoise : public ::testing::TestWithParam<std::optional<double>> {};

/// What remains is rounding of pulse widths (none: commands are twentieths), the steps of 0.02 s of
/// the simulator's pose and of up to 0.2 s of the shooting segments: under a hundredth of every
/// coefficient that is not itself tiny.
TEST_P(NoNoise, GivesTheTruthToDiscretisation) {
  const VesselModel truth = testing::StableBoat(GetParam());
  const auto fit = Estimate(Observe(testing::StableBoatTrack(truth, 400.0, 11), 0.0, 1),
                            Lagging(GetParam().has_value()));
  ASSERT_TRUE(fit.has_value());
  EXPECT_TRUE(fit->converged);
  EXPECT_TRUE(fit->separability.directions.empty());
  const Eigen::VectorXd expected = fit->unknowns.In(truth);
  for (Eigen::Index j = 0; j < expected.size(); ++j) {
    EXPECT_NEAR(fit->theta[j], expected[j], 0.001 + 0.005 * std::abs(expected[j]))
        << NameOf(fit->unknowns, static_cast<std::size_t>(j));
  }
}

INSTANTIATE_TEST_SUITE_P(Lags, NoNoise,
                         ::testing::Values(std::optional<double>(), std::optional(0.4)));

/// A start from a boat that nothing pushes ends where the one from weak-form IV does.
TEST(EstimateOutputError, DoesNotDependOnWhereItStarts) {
  const auto dataset = Observe(testing::StableBoatTrack(testing::StableBoat(), 200.0, 12), 1.0, 3);
  const auto columns = AllColumns(Parameterization::kPropeller);
  VesselModel nothing = testing::StableBoat();
  for (Eigen::VectorXd& theta : nothing.theta) theta.setZero();
  const auto from_nothing = EstimateOutputError(dataset, {}, columns, nothing, {});
  const auto from_weak = Estimate(dataset, {});
  ASSERT_TRUE(from_nothing.has_value());
  ASSERT_TRUE(from_weak.has_value());
  const Eigen::VectorXd errors = ClusterCovariance(*from_weak).diagonal().cwiseSqrt();
  // The ridge prior has another centre; its effect is of the order of its weight.
  EXPECT_LT((from_nothing->theta - from_weak->theta).cwiseQuotient(errors).cwiseAbs().maxCoeff(),
            0.3);
}

/// Without disturbances the bounds are those of a correct model: standard errors match the scatter
/// of 40 repeats, that itself is known to 1 / sqrt(78) = 11 % a coefficient, and what keeps model
/// and measurement apart is the sensors' noise.
TEST(EstimateOutputError, StandardErrorsMatchTheScatterOfReplicates) {
  constexpr int kRepeats = 40;
  const VesselModel truth = testing::StableBoat();
  const auto track = testing::StableBoatTrack(truth, 400.0, 13);
  Eigen::MatrixXd errors(35, kRepeats);
  Eigen::VectorXd clustered = Eigen::VectorXd::Zero(35);
  Eigen::VectorXd naive = Eigen::VectorXd::Zero(35);
  double misspecification = 0.0;
  for (int i = 0; i < kRepeats; ++i) {
    const auto fit = Estimate(Observe(track, 1.0, 100 + static_cast<std::uint64_t>(i)), {});
    ASSERT_TRUE(fit.has_value()) << i;
    errors.col(i) = fit->theta - fit->unknowns.In(truth);
    clustered += ClusterCovariance(*fit).diagonal() / kRepeats;
    naive += NaiveCovariance(*fit).diagonal() / kRepeats;
    misspecification += Misspecification(*fit) / kRepeats;
    EXPECT_NEAR(fit->residual_variance, 1.0, 0.2);  // medians of 2,000 are known to 3 %
    EXPECT_LT(fit->position_misfit, 1.15);
    EXPECT_LT(fit->heading_misfit, 1.15);
  }
  const Eigen::VectorXd mean = errors.rowwise().mean();
  const Eigen::VectorXd scatter =
      ((errors.colwise() - mean).rowwise().squaredNorm() / (kRepeats - 1)).cwiseSqrt();
  const Eigen::ArrayXd by_cluster = clustered.cwiseSqrt().cwiseQuotient(scatter).array();
  const Eigen::ArrayXd by_residuals = naive.cwiseSqrt().cwiseQuotient(scatter).array();
  // Three of those 11 % either way for the worst of 35; correlated as they are, a third of that for
  // their mean. Leave-one-out errs on the wide side.
  EXPECT_GT(by_cluster.minCoeff(), 0.7);
  EXPECT_LT(by_cluster.maxCoeff(), 1.6);
  EXPECT_NEAR(by_cluster.log().mean(), 0.05, 0.12);
  EXPECT_NEAR(by_residuals.log().mean(), 0.0, 0.12);
  // The worst of three equations, each known to a tenth, and leave-one-out on the wide side.
  EXPECT_GT(misspecification, 1.0);
  EXPECT_LT(misspecification, 1.3);
  // No bias to speak of: the mean of 40 has standard error scatter / sqrt(40).
  EXPECT_LT((mean.cwiseQuotient(scatter) * std::sqrt(1.0 * kRepeats)).cwiseAbs().maxCoeff(), 4.0);
}

/// Coloured position errors are not what white noise explains: the alarm rises.
TEST(Misspecification, RisesWithErrorsThatAreNotWhite) {
  auto dataset = Observe(testing::StableBoatTrack(testing::StableBoat(), 400.0, 13), 1.0, 4);
  for (RawSignals& signals : dataset.signals) {
    for (std::size_t i = 0; i < signals.north_m.values.size(); ++i) {
      const double t = signals.north_m.times_s[i];
      signals.north_m.values[i] += 0.1 * std::sin(1.1 * t);
      signals.east_m.values[i] += 0.1 * std::sin(1.3 * t);
    }
  }
  const auto fit = Estimate(dataset, {});
  ASSERT_TRUE(fit.has_value());
  EXPECT_GT(Misspecification(*fit), 1.5);
  EXPECT_GT(fit->position_misfit, 1.5);
}

/// One straight run under one command: the constant and the thrust of that command are one number.
TEST(EstimateOutputError, NamesWhatOneStraightRunCannotSeparate) {
  constexpr double kCommand = 0.6;
  const VesselModel truth = testing::StableBoat();
  const auto track = Simulate(truth, {}, {{0.0, {kCommand, kCommand}}}, 60.0, 0.02);
  const auto fit = Estimate(Observe(track, 1.0, 7), {});
  ASSERT_TRUE(fit.has_value());
  const auto place = [&](const std::string& name) {
    for (std::size_t j = 0; j < 35; ++j) {
      if (NameOf(fit->unknowns, j) == name) return j;
    }
    return std::size_t{35};
  };
  const std::size_t one = place("SURGE 1");
  const std::size_t square = place("SURGE f:d^2");
  const std::size_t linear = place("SURGE f:d");
  for (const std::size_t j : {one, square, linear, place("SURGE r:d"), place("YAW f:d")}) {
    EXPECT_FALSE(fit->separability.separable[j]) << NameOf(fit->unknowns, j);
  }
  // Two combinations of the three leave the acceleration as it is.
  int found = 0;
  for (const InseparableDirection& direction : fit->separability.directions) {
    const bool of_these =
        std::all_of(direction.unknowns.begin(), direction.unknowns.end(),
                    [&](std::size_t j) { return j == one || j == square || j == linear; });
    if (!of_these) continue;
    ++found;
    const auto by = [&](std::size_t j) { return direction.change[static_cast<Eigen::Index>(j)]; };
    const double acceleration =
        by(one) + 2.0 * kCommand * kCommand * by(square) + 2.0 * kCommand * by(linear);
    EXPECT_NEAR(acceleration, 0.0, 1e-3);
    const Refusal said = Explain(direction, fit->unknowns);
    EXPECT_THAT(said.subject, HasSubstr("SURGE f:d"));
    EXPECT_THAT(said.reason, HasSubstr("collinear"));
  }
  EXPECT_EQ(found, 2);
  EXPECT_TRUE(fit->theta.allFinite());
  EXPECT_TRUE(ClusterCovariance(*fit).allFinite());
  EXPECT_TRUE(std::isfinite(Misspecification(*fit)));
}

/// Ten fixes of a thousand, metres to tens of metres off.
TEST(EstimateOutputError, IsRobustToOutlyingFixes) {
  const auto track = testing::StableBoatTrack(testing::StableBoat(), 200.0, 14);
  const PreparedDataset clean = Observe(track, 1.0, 8);
  PreparedDataset outlying = clean;
  for (RawSignals& signals : outlying.signals) {
    for (std::size_t i = 50; i < signals.north_m.values.size(); i += 100) {
      signals.north_m.values[i] += 3.0 + 0.03 * static_cast<double>(i);
      signals.east_m.values[i] -= 8.0;
    }
  }
  const auto before = Estimate(clean, {});
  const auto after = Estimate(outlying, {});
  OutputErrorOptions squares;
  squares.huber_threshold = 100.0;
  const auto without = Estimate(outlying, {}, squares);
  ASSERT_TRUE(before.has_value() && after.has_value() && without.has_value());
  const Eigen::VectorXd errors = ClusterCovariance(*before).diagonal().cwiseSqrt();
  const auto moved = [&](const OutputErrorFit& fit) {
    return (fit.theta - before->theta).cwiseQuotient(errors).norm() / std::sqrt(35.0);
  };
  EXPECT_LT(moved(*after), 0.5);
  EXPECT_GT(moved(*without), 2.0);
  EXPECT_GE(after->beyond_huber_threshold, before->beyond_huber_threshold + 8);
}

TEST(EstimateOutputError, RefusesARecordingTooShortForItsCoefficients) {
  const auto track = testing::StableBoatTrack(testing::StableBoat(), 8.0, 15);
  const auto fit = Estimate(Observe(track, 1.0, 9), {});
  ASSERT_FALSE(fit.has_value());
  EXPECT_THAT(fit.error().reason, HasSubstr("too few"));
}

TEST(EstimateOutputError, RefusesOptionsOutOfRange) {
  OutputErrorOptions options;
  options.shooting_segments.length_s = 0.5;
  const auto refusal = options.Validate();
  ASSERT_TRUE(refusal.has_value());
  EXPECT_THAT(refusal->reason, HasSubstr("shooting_segments.length_s"));
}

}  // namespace
}  // namespace telltale
