#include "telltale/core/diagnosis/hypotheses/levenberg_marquardt.hpp"

#include <cmath>
#include <functional>

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
    return MinimiseCost(posterior, posterior.At(Eigen::VectorXd::Constant(1, start))).point;
  }

  double CostAt(double value) const {
    const EffectParameters parameters({&effect_});
    return EffectPosterior(error_model_, metric_, parameters)
        .At(Eigen::VectorXd::Constant(1, value))
        .cost;
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

const Eigen::MatrixXd kNoise = 0.3 * testing::Pattern(kFitRows, kFitWindows, 2.3);
constexpr double kFitObservations = 0.5 * static_cast<double>(kFitWindows);

/// n ln Q + a^2 / 4 is lower at the minimum than on either side of it.
void ExpectLowestAt(double a, const std::function<double(double)>& square, double step) {
  const auto cost = [&](double x) { return kFitObservations * std::log(square(x)) + 0.25 * x * x; };
  EXPECT_LT(cost(a), cost(a - step)) << a;
  EXPECT_LT(cost(a), cost(a + step)) << a;
}

TEST(LevenbergMarquardt, FindsTheMinimumOfALinearProblem) {
  const auto errors_at = [](double a) { return ((3.0 - a) * kPattern + kNoise).eval(); };
  const OneParameter problem([&](const auto& effects) { return errors_at(ValueOf(effects)); });
  for (const double start : {0.0, -20.0, 50.0}) {
    const double a = problem.MinimumFrom(start).scaled[0];
    EXPECT_NEAR(a, 3.0, 0.5) << start;
    ExpectLowestAt(
        a, [&](double x) { return errors_at(x).squaredNorm(); }, 0.01);
  }
}

TEST(LevenbergMarquardt, FindsTheMinimumOfANonlinearProblem) {
  const auto errors_at = [](double a) { return ((std::exp(a) - 5.0) * kPattern + kNoise).eval(); };
  const OneParameter problem([&](const auto& effects) { return errors_at(ValueOf(effects)); });
  const double a = problem.MinimumFrom(0.0).scaled[0];
  EXPECT_NEAR(a, std::log(5.0), 0.1);
  ExpectLowestAt(
      a, [&](double x) { return errors_at(x).squaredNorm(); }, 0.01);
}

TEST(LevenbergMarquardt, StaysWithinTheBounds) {
  int errors_made = 0;
  const OneParameter problem(
      [&](const auto& effects) {
        ++errors_made;
        return ((3.0 - ValueOf(effects)) * kPattern).eval();
      },
      2.0);
  EXPECT_DOUBLE_EQ(problem.MinimumFrom(0.0).scaled[0], 2.0);
  // At the bound no damping leads anywhere, so none is tried: start, slope, step, slope.
  EXPECT_EQ(errors_made, 4);
}

TEST(LevenbergMarquardt, NeverRaisesTheCost) {
  const OneParameter problem(
      [](const auto& effects) { return (std::cos(3.0 * ValueOf(effects)) * kPattern).eval(); });
  for (const double start : {0.1, 0.4, 1.0, 2.0}) {
    EXPECT_LE(problem.MinimumFrom(start).cost, problem.CostAt(start)) << start;
  }
}

}  // namespace
}  // namespace telltale
