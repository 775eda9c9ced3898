#include "telltale/core/diagnosis/hypotheses/levenberg_marquardt.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kFitRows = 3;
constexpr Eigen::Index kFitWindows = 10;

/// Errors that a test makes of one scaled parameter, by a metric of unit errors.
class OneParameter {
 public:
  explicit OneParameter(ErrorModel error_model, double upper = 100.0)
      : error_model_(std::move(error_model)), effect_("one", {{"size", "1", 1.0, -100.0, upper}}) {}

  PosteriorPoint MinimumFrom(double start) const {
    const EffectParameters parameters({&effect_});
    const EffectPosterior posterior(error_model_, metric_, parameters);
    return MinimiseCost(posterior, posterior.At(Eigen::VectorXd::Constant(1, start)));
  }

 private:
  ErrorModel error_model_;
  testing::InertEffect effect_;
  Sensitivity recording_ =
      testing::SensitivityOfErrors(Eigen::MatrixXd::Zero(kFitRows, kFitWindows), 0, 0);
  ResidualMetric metric_{testing::UnitBaseline(kFitRows, 0, 0), recording_, EveryWindow(recording_),
                         false};
};

double ValueOf(const std::vector<ModelledEffect>& effects) {
  return effects.front().values.front();
}

const Eigen::MatrixXd kPattern = testing::Pattern(kFitRows, kFitWindows, 0.7);

// Errors (3 - a) p: the cost p'p (3 - a)^2 + a^2 / 4 is least at a = 3 p'p / (p'p + 1 / 4).
TEST(LevenbergMarquardt, FindsTheMinimumOfALinearProblem) {
  const OneParameter problem(
      [](const auto& effects) { return ((3.0 - ValueOf(effects)) * kPattern).eval(); });
  const double square = kPattern.squaredNorm();
  for (const double start : {0.0, -20.0, 50.0}) {
    const PosteriorPoint minimum = problem.MinimumFrom(start);
    EXPECT_NEAR(minimum.scaled[0], 3.0 * square / (square + 0.25), 1e-4) << start;
    EXPECT_NEAR(minimum.cost, minimum.square + 0.25 * minimum.scaled[0] * minimum.scaled[0], 1e-12);
  }
}

// Errors (e^a - 5) p: the gradient 2 p'p (e^a - 5) e^a + a / 2 vanishes.
TEST(LevenbergMarquardt, FindsTheMinimumOfANonlinearProblem) {
  const OneParameter problem(
      [](const auto& effects) { return ((std::exp(ValueOf(effects)) - 5.0) * kPattern).eval(); });
  const double a = problem.MinimumFrom(0.0).scaled[0];
  const double curvature = 2.0 * kPattern.squaredNorm() * std::exp(2.0 * a);
  const double gradient =
      2.0 * kPattern.squaredNorm() * (std::exp(a) - 5.0) * std::exp(a) + 0.5 * a;
  EXPECT_NEAR(a, std::log(5.0), 0.01);
  EXPECT_LT(std::abs(gradient / curvature), 1e-3);
}

TEST(LevenbergMarquardt, StaysWithinTheBounds) {
  const OneParameter problem(
      [](const auto& effects) { return ((3.0 - ValueOf(effects)) * kPattern).eval(); }, 2.0);
  EXPECT_DOUBLE_EQ(problem.MinimumFrom(0.0).scaled[0], 2.0);
}

TEST(LevenbergMarquardt, NeverRaisesTheCost) {
  const OneParameter problem(
      [](const auto& effects) { return (std::cos(3.0 * ValueOf(effects)) * kPattern).eval(); });
  for (const double start : {0.1, 0.5, 1.0, 2.0}) {
    const double before = std::pow(std::cos(3.0 * start), 2) * kPattern.squaredNorm();
    EXPECT_LE(problem.MinimumFrom(start).cost, before + 0.25 * start * start) << start;
  }
}

}  // namespace
}  // namespace telltale
