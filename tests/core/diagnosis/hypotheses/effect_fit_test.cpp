#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "support/hand_made_diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/hypotheses/variation.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kRows = 3;
constexpr Eigen::Index kWindows = 40;

ResidualMetric UnitMetric() {
  const Sensitivity recording =
      testing::SensitivityOfErrors(Eigen::MatrixXd::Zero(kRows, kWindows), 0, 0);
  return {testing::UnitBaseline(kRows, 0, 0), recording, EveryWindow(recording), false};
}

/// Errors e + b0 v0 + b1 v1 of an effect of two parameters, typically 2 and 0.5.
class LinearProblem : public ::testing::Test {
 protected:
  const testing::InertEffect effect_{
      "linear", {{"first", "N", 2.0, -200.0, 200.0}, {"second", "m", 0.5, -50.0, 50.0}}};
  const Eigen::MatrixXd first_ = testing::Pattern(kRows, kWindows, 0.7);
  const Eigen::MatrixXd second_ = testing::Pattern(kRows, kWindows, 1.9);
  const Eigen::MatrixXd errors_ =
      -1.5 * first_ + 0.3 * second_ + 0.8 * testing::Pattern(kRows, kWindows, 2.3);
  const ErrorModel error_model_ = [this](const std::vector<ModelledEffect>& effects) {
    if (effects.empty()) return errors_;
    const std::vector<double>& values = effects.front().values;
    return (errors_ + values[0] * first_ + values[1] * second_).eval();
  };
  const ResidualMetric metric_ = UnitMetric();
  const EffectFit fit_ = FitEffects(error_model_, metric_, {&effect_}, {Eigen::Vector2d::Zero()});

  // The posterior of scaled values x: errors e + J x of unknown scale, prior N(0, 4 I), whose
  // weight is the square that is left per observation. n is half an observation a window.
  static constexpr double kObservations = 0.5 * static_cast<double>(kWindows);
  const Eigen::MatrixXd jacobian_ = [this] {
    Eigen::MatrixXd jacobian(kRows * kWindows, 2);
    jacobian << 2.0 * first_.reshaped(), 0.5 * second_.reshaped();
    return jacobian;
  }();
  const Eigen::Matrix2d prior_ = 0.25 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d scaled_ = [this] {
    Eigen::Vector2d scaled = Eigen::Vector2d::Zero();
    for (int round = 0; round < 50; ++round) {
      const double square = (errors_.reshaped() + jacobian_ * scaled).squaredNorm();
      scaled = -(jacobian_.transpose() * jacobian_ + square / kObservations * prior_)
                    .ldlt()
                    .solve(Eigen::Vector2d(jacobian_.transpose() * errors_.reshaped()));
    }
    return scaled;
  }();
  const double square_ = (errors_.reshaped() + jacobian_ * scaled_).squaredNorm();
  // n / Q times the curvature, and the prior.
  const Eigen::Matrix2d information_ =
      kObservations / square_ * jacobian_.transpose() * jacobian_ + prior_;
};

TEST_F(LinearProblem, HasTheModeOfThePosterior) {
  ASSERT_EQ(fit_.effects.size(), 1U);
  EXPECT_NEAR(fit_.effects[0].values[0], 2.0 * scaled_[0], 1e-3);
  EXPECT_NEAR(fit_.effects[0].values[1], 0.5 * scaled_[1], 1e-3);
  EXPECT_NEAR(fit_.square, square_, 1e-3);
}

TEST_F(LinearProblem, HasThePosteriorCovarianceInClosedForm) {
  const Eigen::Vector2d typical(2.0, 0.5);
  const Eigen::Matrix2d expected =
      typical.asDiagonal() * information_.inverse() * typical.asDiagonal();
  EXPECT_TRUE(fit_.covariance.isApprox(expected, 1e-3)) << fit_.covariance << "\n" << expected;
}

// docs/concepts/diagnosis.md (89).
TEST_F(LinearProblem, IsScoredByLaplacesEvidence) {
  const double expected = kObservations * std::log(square_ / errors_.squaredNorm()) +
                          scaled_.dot(prior_ * scaled_) +
                          std::log(information_.determinant() / prior_.determinant());
  EXPECT_NEAR(fit_.score, expected, 1e-3);
  EXPECT_LT(fit_.score, 0.0);
}

TEST_F(LinearProblem, ReturnsTheErrorsThatTheEffectLeaves) {
  EXPECT_TRUE(fit_.errors.reshaped().isApprox(errors_.reshaped() + jacobian_ * scaled_, 1e-3));
  EXPECT_TRUE(fit_.variation.IsEmpty());
}

/// Errors with minima at both signs, the deeper one at +2.
TEST(FitEffects, KeepsTheLowestOfAllStarts) {
  const testing::InertEffect effect("two_minima", {{"size", "1", 1.0, -10.0, 10.0}});
  const Eigen::MatrixXd pattern = testing::Pattern(kRows, kWindows, 0.7);
  const ErrorModel error_model = [&](const std::vector<ModelledEffect>& effects) {
    const double v = effects.empty() ? 0.0 : effects.front().values.front();
    return ((v * v - 4.0 + 0.2 * (v - 2.0)) * pattern).eval();
  };
  const ErrorModel with_noise = [&](const std::vector<ModelledEffect>& effects) {
    const double v = effects.empty() ? 0.0 : effects.front().values.front();
    return (error_model(effects) + 0.5 * (v - 2.0) * testing::Pattern(kRows, kWindows, 1.9)).eval();
  };
  const Eigen::VectorXd negative = Eigen::VectorXd::Constant(1, -3.0);
  const Eigen::VectorXd positive = Eigen::VectorXd::Constant(1, 3.0);
  const ResidualMetric metric = UnitMetric();
  EXPECT_LT(FitEffects(with_noise, metric, {&effect}, {negative}).effects[0].values[0], -1.0);
  EXPECT_NEAR(FitEffects(with_noise, metric, {&effect}, {negative, positive}).effects[0].values[0],
              2.0, 0.05);
}

/// What a size that differs from window to window by `scatter` leaves to an effect, beside errors
/// of 0.1.
EffectFit FitWithScatter(double scatter, const Effect& effect) {
  const Eigen::MatrixXd pattern = 10.0 * testing::Pattern(kRows, kWindows, 0.7);
  const Eigen::MatrixXd noise = testing::Pattern(kRows, kWindows, 2.3);
  const ErrorModel error_model = [&](const std::vector<ModelledEffect>& effects) {
    const double v = effects.empty() ? 0.0 : effects.front().values.front();
    Eigen::MatrixXd errors = noise;
    for (Eigen::Index w = 0; w < kWindows; ++w) {
      const double size = 2.0 + (w % 2 == 0 ? scatter : -scatter);
      errors.col(w) += (v - size) * pattern.col(w);
    }
    return errors;
  };
  return FitEffects(error_model, UnitMetric(), {&effect}, {Eigen::VectorXd::Constant(1, 1.0)});
}

const testing::InertEffect& Gusty() {
  static const testing::InertEffect effect("gusty", {{"size", "1", 1.0, -10.0, 10.0}}, 0.2);
  return effect;
}

TEST(FitEffects, AllowsForGustsWhereTheSizeDiffersFromWindowToWindow) {
  const EffectFit fit = FitWithScatter(0.4, Gusty());
  ASSERT_EQ(fit.variation.by_window.cols(), 1);
  // One standard deviation is the turbulence intensity, 0.2, times the mean, 2.
  EXPECT_TRUE(fit.variation.by_window.reshaped().isApprox(
      0.4 * 10.0 * testing::Pattern(kRows, kWindows, 0.7).reshaped(), 0.01));
  EXPECT_NEAR(fit.effects[0].values[0], 2.0, 0.1);
}

TEST(FitEffects, AllowsForNoGustsWhereTheSizeIsConstant) {
  EXPECT_TRUE(FitWithScatter(0.0, Gusty()).variation.IsEmpty());
}

// What acts at times only is no explanation of what acts always: there its steady likeness is
// likelier, and here it is.
TEST(FitEffects, AnIntermittentEffectKeepsItsScatter) {
  const std::vector<EffectParameter> size = {{"size", "1", 1.0, -10.0, 10.0}};
  const testing::InertEffect steady("steady", size);
  const testing::InertEffect intermittent("intermittent", size, 0.0, {1.5});
  EXPECT_FALSE(FitWithScatter(0.0, intermittent).variation.IsEmpty());
  EXPECT_LT(FitWithScatter(0.0, steady).score, FitWithScatter(0.0, intermittent).score);
  EXPECT_LT(FitWithScatter(1.5, intermittent).score, FitWithScatter(1.5, steady).score);
}

// Where both allow for the same scatter, there is as much of it as they stand for, and the mean is
// the same whether it is allowed for or not: all windows show the effect alike. n is half an
// observation a window.
TEST(FitEffects, TheScatterOfAnIntermittentEffectCostsAParameter) {
  const std::vector<EffectParameter> size = {{"size", "1", 100.0, -10.0, 10.0}};
  const testing::InertEffect gusty("gusty", size, 1.0);
  const testing::InertEffect intermittent("intermittent", size, 0.0, {2.0});  // the mean
  const Eigen::VectorXd pattern = testing::Pattern(kRows, 1, 0.7);
  const ErrorModel error_model = [&](const std::vector<ModelledEffect>& effects) {
    const double v = effects.empty() ? 0.0 : effects.front().values.front();
    Eigen::MatrixXd errors(kRows, kWindows);
    for (Eigen::Index w = 0; w < kWindows; ++w) {
      errors.col(w) = (v - (w % 2 == 0 ? 5.0 : -1.0)) * pattern;
    }
    return errors;
  };
  const auto score_of = [&](const Effect& effect) {
    return FitEffects(error_model, UnitMetric(), {&effect}, {Eigen::VectorXd::Constant(1, 1.0)})
        .score;
  };
  // The gusts are those of a mean that the first fit leaves a thousandth short, by its damping: of
  // a variance two thousandths smaller, n times.
  EXPECT_NEAR(score_of(intermittent) - score_of(gusty),
              std::log(0.5 * static_cast<double>(kWindows)),
              0.5 * static_cast<double>(kWindows) * 2e-3);
}

/// Fit of an effect that acts by two sizes in turn, window by window.
EffectFit FitInTurn(const Effect& effect, double even, double odd, const Eigen::MatrixXd& pattern) {
  const ErrorModel error_model = [&](const std::vector<ModelledEffect>& effects) {
    const double v = effects.empty() ? 0.0 : effects.front().values.front();
    Eigen::MatrixXd errors = testing::Pattern(kRows, kWindows, 2.3);
    for (Eigen::Index w = 0; w < kWindows; ++w) {
      errors.col(w) += (v - (w % 2 == 0 ? even : odd)) * pattern.col(w);
    }
    return errors;
  };
  return FitEffects(error_model, UnitMetric(), {&effect}, {Eigen::VectorXd::Constant(1, 1.0)});
}

// Whatever the mean: 2, on either side of zero, and wherever the fit starts.
TEST(FitEffects, AnIntermittentEffectTakesTheLikeliestScatterAndItsSide) {
  const testing::InertEffect intermittent("intermittent", {{"size", "1", 1.0, -10.0, 10.0}}, 0.0,
                                          {0.2, 2.0, 20.0});
  const Eigen::MatrixXd pattern = 10.0 * testing::Pattern(kRows, kWindows, 0.7);
  for (const double side : {-1.0, 1.0}) {
    const EffectFit fit = FitInTurn(intermittent, side * 4.0, side * 0.0, pattern);
    EXPECT_EQ(fit.intermittent_sd, 2.0);
    EXPECT_NEAR(fit.effects[0].values[0], 2.0 * side, 0.3);
    EXPECT_NEAR(fit.variation.by_window.norm() / pattern.norm(), 2.0, 1e-9);
  }
}

// What acts in one of forty windows, by four, has a mean of 0.1. A scatter of 2 stands for 0.3 at
// least, of what acts for a fiftieth of the time.
TEST(FitEffects, AnIntermittentEffectActsByNoLessThanItsScatterStandsFor) {
  const testing::InertEffect intermittent("intermittent", {{"size", "1", 1.0, -10.0, 10.0}}, 0.0,
                                          {2.0});
  const Eigen::MatrixXd pattern = 10.0 * testing::Pattern(kRows, kWindows, 0.7);
  const ErrorModel error_model = [&](const std::vector<ModelledEffect>& effects) {
    const double v = effects.empty() ? 0.0 : effects.front().values.front();
    Eigen::MatrixXd errors = testing::Pattern(kRows, kWindows, 2.3) + v * pattern;
    errors.col(7) -= 4.0 * pattern.col(7);
    return errors;
  };
  const EffectFit fit =
      FitEffects(error_model, UnitMetric(), {&intermittent}, {Eigen::VectorXd::Constant(1, 1.0)});
  EXPECT_NEAR(fit.effects[0].values[0], 0.15 * 2.0, 1e-6);
}

// What acts by 3 and by 1 in turn acts all the time. A scatter of 1 stands for a mean of 1 at most,
// of what acts by 2 for half of the time.
TEST(FitEffects, AnIntermittentEffectActsForHalfOfTheTimeAtMost) {
  const testing::InertEffect intermittent("intermittent", {{"size", "1", 1.0, -10.0, 10.0}}, 0.0,
                                          {1.0});
  const Eigen::MatrixXd pattern = 10.0 * testing::Pattern(kRows, kWindows, 0.7);
  for (const double side : {-1.0, 1.0}) {
    const EffectFit fit = FitInTurn(intermittent, side * 3.0, side * 1.0, pattern);
    EXPECT_NEAR(fit.effects[0].values[0], side, 1e-6);
  }
}

// The errors act by 4 and by 0 in turn. Beside a steady effect that errs alike, any mean of what
// comes and goes will do; beside one that errs otherwise, 2.
TEST(FitEffects, AnIntermittentEffectHasAMeanThatOthersLeaveIt) {
  const std::vector<EffectParameter> size = {{"size", "1", 1.0, -10.0, 10.0}};
  const testing::InertEffect steady("steady", size);
  const testing::InertEffect intermittent("intermittent", size, 0.0, {2.0});
  const Eigen::MatrixXd pattern = 10.0 * testing::Pattern(kRows, kWindows, 0.7);
  const auto score_beside = [&](const Eigen::MatrixXd& of_steady) {
    const ErrorModel error_model = [&](const std::vector<ModelledEffect>& effects) {
      Eigen::MatrixXd errors = testing::Pattern(kRows, kWindows, 2.3);
      for (Eigen::Index w = 0; w < kWindows; w += 2) errors.col(w) -= 4.0 * pattern.col(w);
      for (const ModelledEffect& modelled : effects) {
        errors += modelled.values.front() * (modelled.effect == &steady ? of_steady : pattern);
      }
      return errors;
    };
    return FitEffects(error_model, UnitMetric(), {&steady, &intermittent},
                      {Eigen::Vector2d(0.0, 1.0)})
        .score;
  };
  EXPECT_GE(score_beside(pattern), 0.0);
  EXPECT_LT(score_beside(testing::Pattern(kRows, kWindows, 1.9)), -20.0);
}

/// An acceleration ahead of its own value, with gusts of a fifth that last 4 s.
class GustyPush final : public Effect {
 public:
  static constexpr double kLastsS = 4.0;

  GustyPush()
      : Effect({.name = "gusty_push",
                .title = "",
                .equation = "",
                .source = "",
                .parameters = {{"size", "m/s^2", 1.0, -10.0, 10.0}},
                .settled_by = "",
                .hook = Hook::kAcceleration,
                .turbulence_intensity = 0.2,
                .turbulence_time_s = kLastsS}) {}
  std::string Describe(EffectValues) const override { return "gusty push"; }
  NuDot AddedAcceleration(EffectValues values, const InstantState&) const override {
    return {values[0], 0.0, 0.0};
  }
};

// Where errors are the push itself, every half second of a window, they covary by sigma^2
// exp(-t / T), of which the courses that are left out have 15 % at most.
TEST(VariationOf, CovariesAsAFirstOrderProcessWithinAWindow) {
  constexpr double kWindowS = 5.0, kMean = 3.0;
  static constexpr Eigen::Index kBins = 11;
  const GustyPush push;
  const ErrorModel error_model = [](const std::vector<ModelledEffect>& effects) {
    Eigen::MatrixXd errors(kBins, 1);
    for (Eigen::Index i = 0; i < kBins; ++i) {
      InstantState instant;
      instant.time_s = 17.0 + 0.5 * static_cast<double>(i);
      errors(i, 0) = effects[0].effect->AddedAcceleration(effects[0].values, instant).u;
    }
    return errors;
  };
  const std::vector<ModelledEffect> effects = {{&push, {kMean}}};
  const Eigen::MatrixXd gusts =
      VariationOf(effects, 0.0, error_model(effects), error_model, kWindowS).by_window;
  const double variance = 0.2 * kMean * 0.2 * kMean;
  for (Eigen::Index i = 0; i < kBins; ++i) {
    for (Eigen::Index j = 0; j < kBins; ++j) {
      const double apart_s = 0.5 * static_cast<double>(std::abs(i - j));
      EXPECT_NEAR(gusts.row(i).dot(gusts.row(j)) / variance,
                  std::exp(-apart_s / GustyPush::kLastsS), 0.15)
          << i << ", " << j;
    }
  }
}

// Where a thruster stands still its spells show nothing: that is no evidence, and no number is
// lost.
TEST(ScatterDeficit, IsFiniteWhereNothingShows) {
  const Eigen::MatrixXd errors = testing::Pattern(kRows, kWindows, 2.3);
  ErrorVariation variation;
  variation.by_window = Eigen::MatrixXd::Zero(errors.size(), 1);
  variation.spells = {0};
  const double deficit = ScatterDeficit(variation, errors, UnitMetric());
  EXPECT_TRUE(std::isfinite(deficit));
  EXPECT_GT(deficit, 0.0);
}

/// What wind, a current and spells do to errors that they move in proportion.
ErrorVariation VariationOfAll() {
  std::vector<ModelledEffect> effects;
  for (const char* name : {"wind", "intermittent_thrust_loss", "current"}) {
    ModelledEffect& modelled = effects.emplace_back(ModelledEffect{FindEffect(name), {}});
    for (const EffectParameter& parameter : modelled.effect->Parameters()) {
      modelled.values.push_back(parameter.is_shape ? parameter.prior_mean : parameter.typical);
    }
  }
  const ErrorModel error_model = [](const std::vector<ModelledEffect>& all) {
    double sum = 0.0;
    for (const ModelledEffect& one : all) {
      for (const double value : one.values) sum += value;
    }
    return Eigen::MatrixXd::Constant(kRows, kWindows, sum).eval();
  };
  return VariationOf(effects, 0.2, error_model(effects), error_model, 5.0);
}

// Two components of wind by three courses, and eleven of spells, up to five half turns; of the
// spells the first is the one that lasts the window. The two components of a current drift.
TEST(VariationOf, TellsWhatDriftsFromWhatVariesByWindow) {
  const ErrorVariation variation = VariationOfAll();
  EXPECT_EQ(variation.by_window.cols(), 2 * 3 + 11);
  EXPECT_EQ(variation.spells, std::vector<Eigen::Index>{6});
  EXPECT_EQ(variation.drifting.cols(), 2);
  EXPECT_EQ(variation.drift_time_s, 120.0);
  // A fifth of the length of (0.2, 0.2) m/s.
  EXPECT_NEAR(variation.drifting(0, 0), 0.2 * std::hypot(0.2, 0.2), 1e-12);
}

TEST(Distance, OfTwoThatPredictAlikeIsTheEvidenceOfTheScatterOfOne) {
  const std::vector<EffectParameter> size = {{"size", "1", 1.0, -10.0, 10.0}};
  const testing::InertEffect steady("steady", size);
  const testing::InertEffect intermittent("intermittent", size, 0.0, {1.0});
  const EffectFit one = FitWithScatter(0.0, steady);
  const EffectFit other = FitWithScatter(0.0, intermittent);
  EXPECT_NEAR(Distance(one, other, UnitMetric()), 0.5 * (other.score - one.score), 1e-2);
}

TEST(EffectFit, NegativeLogPriorCountsShapesInStandardDeviations) {
  EffectFit fit;
  const Effect* payload = FindEffect("payload");
  const EffectParameter& mass = payload->Parameters()[0];
  const EffectParameter& forward = payload->Parameters()[1];
  ASSERT_TRUE(forward.is_shape);
  fit.effects = {{payload, {mass.typical, forward.prior_mean}}};
  EXPECT_EQ(fit.NegativeLogPrior(), 0.0);
  fit.effects.front().values[1] = forward.prior_mean + 3.0 * forward.typical;
  EXPECT_NEAR(fit.NegativeLogPrior(), 4.5, 1e-12);
}

// An output is stuck or not: one that seems to be a third stuck is something else, whichever side.
TEST(EffectFit, NegativeLogPriorDoubtsWhatIsThereInPart) {
  constexpr double kSd = 0.1;
  EffectFit fit;
  fit.effects = {{FindEffect("output_stuck"), {0.01, 1.0, 0.0}}};
  EXPECT_NEAR(fit.NegativeLogPrior(), 0.0, 1e-12);
  for (const auto& [port, starboard] : {std::pair(0.7, 0.0), std::pair(0.0, 0.7)}) {
    fit.effects.front().values = {port, starboard, 0.0};
    EXPECT_NEAR(fit.NegativeLogPrior(), 0.5 * 0.3 * 0.3 / (kSd * kSd), 1e-12);
  }
}

TEST(EffectFit, StacksTheValuesOfItsEffects) {
  EffectFit fit;
  fit.effects = {{FindEffect("thruster_lag"), {0.3}}, {FindEffect("payload"), {0.2, 0.1}}};
  EXPECT_EQ(fit.Values(), Eigen::Vector3d(0.3, 0.2, 0.1));
  EXPECT_EQ(fit.Names(), (std::vector<std::string>{"thruster_lag", "payload"}));
}

}  // namespace
}  // namespace telltale
