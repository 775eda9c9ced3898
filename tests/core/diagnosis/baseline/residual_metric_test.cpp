#include "telltale/core/diagnosis/baseline/residual_metric.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"
#include "support/physical_boat.hpp"

namespace telltale {
namespace {

const testing::LearnedBaseline& SharedFixture() {
  static const testing::LearnedBaseline boat;
  return boat;
}

ResidualMetric MetricOf(bool free_coefficients) {
  const testing::LearnedBaseline& boat = SharedFixture();
  return {boat.nominal, boat.recording, EveryWindow(boat.recording), free_coefficients};
}

TEST(ResidualMetric, RemembersWhetherItFreesTheCoefficients) {
  EXPECT_FALSE(MetricOf(false).FreesCoefficients());
  EXPECT_TRUE(MetricOf(true).FreesCoefficients());
}

// What a coefficient that is as good as free would explain costs next to nothing; held to its
// covariance it costs what a prior asks: x'(I + v v')^-1 x = |x|^2 / (1 + |v|^2) for x along v.
TEST(ResidualMetric, MarginalisesAFreeCoefficient) {
  const testing::LearnedBaseline& boat = SharedFixture();
  const Eigen::VectorXd pattern = boat.recording.by_coefficient.col(0) * 20.0;
  const auto cost = [&](const ResidualMetric& metric) {
    return metric.WhitenColumns(pattern).col(0).dot(
        metric.Unexplained(metric.WhitenColumns(pattern).col(0)));
  };
  EXPECT_LE(cost(MetricOf(true)), 400.0 / (100.0 * 100.0) + 1e-6);  // 20 of 100 standard errors
  EXPECT_GT(cost(MetricOf(false)), 10.0 * cost(MetricOf(true)));
}

// No marginalised variation can make an error count for more than it does by scatter alone.
TEST(ResidualMetric, NeverExceedsTheUnmarginalisedDistance) {
  const testing::LearnedBaseline& boat = SharedFixture();
  const ResidualMetric metric = MetricOf(false);
  const Eigen::VectorXd seen = metric.Whiten(boat.recording.errors);
  EXPECT_GE(metric.SquaredMahalanobis(seen), 0.0);
  EXPECT_LE(metric.SquaredMahalanobis(seen), seen.squaredNorm());
}

// Sherman and Morrison: y' (V + b b' / kappa)^-1 y = y' V^-1 y - (y' V^-1 b)^2 / (kappa + b' V^-1
// b), and the determinant grows by 1 + b' V^-1 b with scatter alone.
TEST(ResidualMetric, WidensForVariationWithinAWindow) {
  const testing::LearnedBaseline& boat = SharedFixture();
  const ResidualMetric metric(boat.nominal, boat.recording, {3}, false);
  const Eigen::VectorXd varying = 4.0 * boat.recording.by_effect_parameter.col(0);
  const ResidualMetric widened = metric.WithWindowVariation(varying);
  const Eigen::VectorXd y = metric.Whiten(boat.recording.errors);
  const Eigen::VectorXd b = metric.WhitenColumns(varying).col(0);
  const double by = b.dot(metric.Unexplained(y));
  const double bb = b.dot(metric.Unexplained(b));
  EXPECT_GT(bb, 1.0);  // or there would be nothing to allow for
  EXPECT_NEAR(widened.SquaredMahalanobis(widened.Whiten(boat.recording.errors)),
              metric.SquaredMahalanobis(y) - by * by / (metric.Kappa() + bb),
              1e-9 * metric.SquaredMahalanobis(y));
  EXPECT_NEAR(
      widened.VariationPenalty(),
      metric.Kappa() * std::log1p(b.squaredNorm() / metric.Kappa()) / metric.RowsPerObservation(),
      1e-12);
}

/// Windows of five seconds whose only error is a scalar of unit variance, and n of half a window.
class DriftingError : public ::testing::Test {
 protected:
  static constexpr Eigen::Index kWindows = 120;
  static constexpr double kDriftS = 120.0, kSd = 10.0;
  static ResidualMetric Metric(Eigen::Index windows) {
    Sensitivity recording = testing::SensitivityOfErrors(Eigen::MatrixXd::Zero(1, windows), 0, 0);
    for (int w = 0; w < windows; ++w) recording.window_times_s.push_back(5.0 * w);
    return {testing::UnitBaseline(1, 0, 0), recording, EveryWindow(recording), false};
  }
  /// What is left of errors that go as a sine of so many half turns over the recording.
  static double LeftOf(double half_turns, const ResidualMetric& metric) {
    Eigen::MatrixXd errors(1, kWindows);
    for (Eigen::Index w = 0; w < kWindows; ++w) {
      errors(0, w) = kSd * std::sin(half_turns * M_PI * static_cast<double>(w) / kWindows);
    }
    return metric.SquaredMahalanobis(metric.Whiten(errors)) / errors.squaredNorm();
  }
  const ResidualMetric metric_ = Metric(kWindows);
  const Eigen::MatrixXd constant_ = Eigen::MatrixXd::Constant(kWindows, 1, kSd);
  const ResidualMetric drifting_ =
      metric_.WithVariation({Eigen::MatrixXd(kWindows, 0), constant_, kDriftS});
  const ResidualMetric varying_ = metric_.WithWindowVariation(constant_);
};

// What varies in every window on its own leaves next to nothing of any course. A drift over two
// minutes leaves as little of a slow one, and more of a course that turns within seconds.
TEST_F(DriftingError, IsTakenUpWhereItIsSlow) {
  EXPECT_LT(LeftOf(1.0, drifting_), 0.02);
  EXPECT_GT(LeftOf(100.0, drifting_), 4.0 * LeftOf(100.0, varying_));
  EXPECT_GT(LeftOf(100.0, drifting_), 4.0 * LeftOf(1.0, drifting_));
}

// A recording shorter than the drift lasts, of one window too, sees one size of it. An error of
// that size is likely: about m = 2 is left of it, since the slow part counts in full where errors
// count by the observation of m rows.
TEST_F(DriftingError, IsOneSizeInAShortRecording) {
  for (const Eigen::Index windows : {1, 3}) {
    const ResidualMetric metric = Metric(windows).WithVariation(
        {Eigen::MatrixXd(windows, 0), Eigen::MatrixXd::Constant(windows, 1, kSd), kDriftS});
    const Eigen::VectorXd errors = Eigen::VectorXd::Constant(windows, kSd);
    const double left = metric.SquaredMahalanobis(metric.Whiten(errors.transpose()));
    EXPECT_GT(left, 0.0) << windows;
    EXPECT_LT(left, 3.0) << windows;
    EXPECT_TRUE(std::isfinite(metric.VariationPenalty())) << windows;
  }
}

// It costs less than so many independent draws.
TEST_F(DriftingError, CostsLessThanWhatVariesInEveryWindow) {
  EXPECT_GT(drifting_.VariationPenalty(), 0.0);
  EXPECT_LT(drifting_.VariationPenalty(), varying_.VariationPenalty());
}

// Scatter of every window is the same as a baseline that has it in its covariance.
TEST(ResidualMetric, WidensForScatterOfEveryWindow) {
  const testing::LearnedBaseline& boat = SharedFixture();
  const Eigen::Index rows = boat.nominal.covariance.rows();
  const Eigen::MatrixXd root = 0.02 * testing::Pattern(rows, 4, 0.7);
  const Eigen::MatrixXd scatter = root * root.transpose();
  NominalBaseline rough = boat.nominal;
  rough.covariance += scatter;
  const ResidualMetric metric = MetricOf(false);
  const ResidualMetric widened = metric.WithWindowScatter(scatter);
  const ResidualMetric expected(rough, boat.recording, EveryWindow(boat.recording), false);
  const Eigen::VectorXd y = expected.Whiten(boat.recording.errors);
  EXPECT_TRUE(widened.Whiten(boat.recording.errors).isApprox(y, 1e-9));
  EXPECT_NEAR(widened.SquaredMahalanobis(y), expected.SquaredMahalanobis(y),
              1e-9 * expected.SquaredMahalanobis(y));
  const double determinants =
      rough.covariance.determinant() / boat.nominal.covariance.determinant();
  EXPECT_NEAR(widened.VariationPenalty(),
              metric.EffectiveObservations() * std::log(determinants) / static_cast<double>(rows),
              1e-6);
}

// A ratio of likelihoods: nothing to tell between equals, and what is gained step by step adds up.
TEST(ResidualMetric, ComputesDevianceFromRatiosOfSquares) {
  const ResidualMetric metric = MetricOf(false);
  EXPECT_EQ(metric.Deviance(7.0, 7.0), 0.0);
  EXPECT_LT(metric.Deviance(5.0, 7.0), 0.0);
  EXPECT_NEAR(metric.Deviance(2.0, 5.0) + metric.Deviance(5.0, 7.0), metric.Deviance(2.0, 7.0),
              1e-12);
}

// A model three standard errors off in every coefficient, and references by the boat itself.
TEST(NominalBaseline, RecalibratesABiasedModel) {
  UncertainModel off = UncertainModelOf(testing::KnownStableBoat()).value();
  Eigen::VectorXd change = 3.0 * off.StandardErrors();
  for (Eigen::Index i = 0; i < change.size(); i += 2) change[i] = -change[i];
  off.model = off.Changed(change);
  std::vector<PreparedDataset> days;
  for (const std::uint64_t seed : {21, 22, 23}) {
    days.push_back(testing::SimulateWithEffects({}, 240.0, 100 * seed));
  }
  std::vector<FreeRuns> runs;
  for (const PreparedDataset& day : days) runs.emplace_back(day, off.model, 5.0);
  const NominalBaseline nominal =
      LearnNominalBaseline(runs, off, EffectParameterRefsOf(EffectLibrary()), 2);
  const PreparedDataset another = testing::SimulateWithEffects({}, 240.0, 3100);
  const FreeRuns runs_of_another(another, off.model, 5.0);
  const double truth = runs_of_another.Errors({testing::StableBoat(), {}}).squaredNorm();
  const double before = runs_of_another.Errors({off.model, {}}).squaredNorm();
  const double after = runs_of_another.Errors(nominal.boat).squaredNorm();
  EXPECT_GT(before, 10.0 * truth);  // or there would be nothing to mend
  // Thirty coefficients from three recordings as long as this one cost a share of its noise.
  EXPECT_LT(after, 1.5 * truth);
}

// Wide bounds and short references let a recalibration by free coefficients run into boats that
// spin up by themselves; a boat of the physical form has drag whatever the references say.
TEST(NominalBaseline, OfThePhysicalFormKeepsABoatThatDoesNotDiverge) {
  FossenVector off = testing::PhysicalBoat();
  for (const FossenParameter parameter :
       {FossenParameter::kYv, FossenParameter::kNr, FossenParameter::kNuv, FossenParameter::kYvv}) {
    off[At(parameter)] *= 0.3;
  }
  const UncertainModel model = UncertainModelOf(testing::KnownPhysicalBoat(off, 2.0)).value();
  std::vector<PreparedDataset> days;
  for (const std::uint64_t seed : {21, 22}) {
    days.push_back(testing::SimulatePhysicalBoat(testing::PhysicalBoat(), 60.0, 100 * seed));
  }
  std::vector<FreeRuns> runs;
  for (const PreparedDataset& day : days) runs.emplace_back(day, model.model, 5.0);
  const PreparedDataset another =
      testing::SimulatePhysicalBoat(testing::PhysicalBoat(), 240.0, 3100);
  const FreeRuns runs_of_another(another, model.model, 5.0);
  const NominalBaseline nominal = LearnNominalBaseline(
      runs, model, EffectParameterRefsOf(EffectLibrary()), 2, {&runs_of_another});
  const double before = runs_of_another.Errors({model.model, {}}).squaredNorm();
  const double after = runs_of_another.Errors(nominal.boat).squaredNorm();
  EXPECT_LT(after, before);
  EXPECT_FALSE(runs_of_another.DivergenceOf(nominal.boat)
                   .IsWorseThan(runs_of_another.DivergenceOf({model.model, {}})));
  const FossenVector found =
      model.ChangedParameters(nominal.coefficients.cwiseProduct(model.StandardErrors()));
  EXPECT_EQ(found, model.physical->range.Within(found));
}

}  // namespace
}  // namespace telltale
