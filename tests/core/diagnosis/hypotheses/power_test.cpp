#include "telltale/core/diagnosis/hypotheses/power.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/student_t_distribution.hpp>

#include "support/hand_made_diagnosis.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"

namespace telltale {
namespace {

constexpr double kPower = kDiagnosis.testability.power;

class PowerTest : public ::testing::Test {
 protected:
  PowerTest() { nominal_.log_reduced_chi_squares = {-0.2, 0.1, 0.1}; }

  DayToDay Days() const { return DayToDayOf(nominal_, left_out_); }

  /// Whether the verdict calls a recording that errs so much, of whose errors the likeliest effect
  /// explains so much.
  bool IsCalled(double before, double explained, double squared_gap, double cost,
                const DayToDay& days) const {
    const double after = (before - explained) / metric_.ExpectedSquare();
    const LackOfFit lack_of_fit{.before = before / metric_.ExpectedSquare(),
                                .after = after,
                                .nominal = std::exp(days.log_nominal),
                                .median = kDiagnosis.ranking.nominal_median * after};
    EffectFit fit;
    fit.effects = {{&effect_, {1.0}}};
    fit.score = metric_.Deviance(before - explained, before) + cost;
    const GapAssessment assessment = AssessGap(0.0, 0.0, 1.0, fit.score, lack_of_fit);
    const Ranking ranking = Rank({{fit}, {}, {}}, metric_, lack_of_fit);
    const Verdict verdict = VerdictOf(assessment, ranking, std::nullopt);
    if (verdict == Verdict::kUnknownCause) return squared_gap > days.squared_limit.value_or(0.0);
    return verdict == Verdict::kExplained;
  }

  double ShareCalled(const ErrorShift& shift, double cost) const {
    return ShareOfDays(shift, [&](double before, double explained, double squared_gap) {
      return IsCalled(before, explained, squared_gap, cost, Days());
    });
  }

  /// How often recordings are called that an effect moves along one direction, of days drawn from
  /// Student's law. `is_called` gets the square before, what the effect explains of it, and G^2.
  template <class IsCalled>
  double ShareOfDays(const ErrorShift& shift, IsCalled is_called) const {
    constexpr int kTrials = 2000;
    const DayToDay days = Days();
    RandomEngine engine(20);
    boost::random::normal_distribution<double> normal;
    boost::random::student_t_distribution<double> student(days.noise.degrees_of_freedom);
    int called = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const double t = student(engine);
      const double noise = std::exp(days.noise.log_mean + days.noise.log_sd * t);
      const double squared_gap = std::exp(days.squared_gap.log_mean + days.squared_gap.log_sd * t) +
                                 shift.AddedToSquaredGap();
      Eigen::VectorXd errors(static_cast<Eigen::Index>(metric_.ExpectedSquare()));
      for (double& error : errors) error = std::sqrt(noise) * normal(engine);
      errors[0] += std::sqrt(shift.noncentrality);
      called += is_called(errors.squaredNorm(), errors[0] * errors[0], squared_gap) ? 1 : 0;
    }
    return static_cast<double>(called) / kTrials;
  }

  /// A shift along `direction` that PowerOf gives kPower.
  ErrorShift Detectable(const ErrorShift& direction, double cost) const {
    double low = 0.0;
    double high = 1e6;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      const double power =
          PowerOf(direction.Times(std::sqrt(middle)), {{.score = cost}}, calm_, Days());
      (power < kPower ? low : high) = middle;
    }
    return direction.Times(std::sqrt(high));
  }

  // The nodes over the days leave half a node of a fifteenth, besides the draws' own scatter.
  static constexpr double kTolerance = 0.5 / 15.0 + 0.02;

  const testing::InertEffect effect_{"inert", {{"size", "1", 1.0, -100.0, 100.0}}};
  const testing::InertEffect breeze_{"breeze", {{"size", "1", 1.0, -10.0, 10.0}}, 0.0, {}, true};
  const testing::ShortRecording short_;
  NominalBaseline nominal_ = testing::UnitBaseline(short_.runs.Rows(), 0, 0);
  std::vector<LeftOutDay> left_out_;
  const ResidualMetric metric_{
      nominal_,
      testing::SensitivityOfErrors(
          Eigen::MatrixXd::Zero(short_.runs.Rows(),
                                static_cast<Eigen::Index>(short_.runs.Windows())),
          0, 0),
      EveryWindow(testing::SensitivityOfErrors(
          Eigen::MatrixXd::Zero(short_.runs.Rows(),
                                static_cast<Eigen::Index>(short_.runs.Windows())),
          0, 0)),
      false};
  const PresentWeather calm_{metric_};
};

TEST_F(PowerTest, IsTheShareOfRecordingsThatAreCalled) {
  for (const double cost : {1.0, 6.0, 60.0}) {
    for (const double share : {0.3, 0.8, 1.2}) {
      const ErrorShift shift{share * metric_.ExpectedSquare(), share};
      EXPECT_NEAR(ShareCalled(shift, cost), PowerOf(shift, {{.score = cost}}, calm_, Days()),
                  kTolerance)
          << "cost " << cost << ", share " << share;
    }
  }
}

// References that err more where they take no part than where they do, as on real boats.
TEST_F(PowerTest, AnEffectOfTheDetectableSizeIsCalledInNineOfTenAmongDifferentDays) {
  left_out_ = {{1.7, 1.5}, {0.7, 0.9}, {0.8, 1.1}, {1.4, 1.9}};
  const double expected = metric_.ExpectedSquare();
  // Effects that move the weighted errors, the size of the gap, and both; and with the recording's
  // own errors or against them.
  for (const ErrorShift& direction :
       {ErrorShift{expected, 0.01}, ErrorShift{0.1 * expected, 1.0}, ErrorShift{expected, 1.0},
        ErrorShift{0.1 * expected, 1.0, 0.5}, ErrorShift{0.1 * expected, 1.0, -0.5}}) {
    const ErrorShift shift = Detectable(direction, 6.0);
    EXPECT_NEAR(ShareCalled(shift, 6.0), kPower, kTolerance)
        << "noncentrality " << shift.noncentrality << ", gap " << shift.squared_gap;
  }
}

TEST_F(PowerTest, DaysThatErrMoreWhereTheyTakeNoPartAskForLargerEffects) {
  const ErrorShift direction{metric_.ExpectedSquare(), 1.0};
  const double within = Detectable(direction, 6.0).noncentrality;
  left_out_ = {{1.7, 1.5}, {0.7, 0.9}, {0.8, 1.1}, {1.4, 1.9}};
  EXPECT_GT(Detectable(direction, 6.0).noncentrality, within);
}

// Where too much is left for a cause to be named, an effect shows by the gap alone.
TEST_F(PowerTest, AnEffectAgainstTheRecordingsOwnErrorsHasToBeLarger) {
  left_out_ = {{8.0, 1.5}, {8.1, 0.9}, {7.9, 1.1}, {8.0, 1.9}};
  const double alone = Detectable({metric_.ExpectedSquare(), 1.0, 0.0}, 6.0).squared_gap;
  const ErrorShift against = Detectable({metric_.ExpectedSquare(), 1.0, -0.5}, 6.0);
  EXPECT_NEAR(against.AddedToSquaredGap(), alone, 1e-6 * alone);
  EXPECT_GT(against.squared_gap, alone);
}

TEST_F(PowerTest, NothingIsCalledAsOftenAsTheLimitLeaves) {
  left_out_ = {{1.7, 1.0}, {0.7, 1.0}, {0.8, 1.0}, {1.4, 1.0}};
  EXPECT_LE(PowerOf({0.0, 0.0}, {{.score = 6.0}}, calm_, Days()), 0.05 + kTolerance);
}

TEST_F(PowerTest, GrowsWithTheEffectAndFallsWithTheCost) {
  const double expected = metric_.ExpectedSquare();
  const ErrorShift smaller{0.5 * expected, 0.5};
  const ErrorShift larger{0.9 * expected, 0.9};
  EXPECT_LT(PowerOf(smaller, {{.score = 5.0}}, calm_, Days()),
            PowerOf(larger, {{.score = 5.0}}, calm_, Days()));
  EXPECT_LE(PowerOf(smaller, {{.score = 9.0}}, calm_, Days()),
            PowerOf(smaller, {{.score = 5.0}}, calm_, Days()));
}

// Beside weather an effect is called where it is added to the weather and named. Errors are drawn
// that weather has left, of a day that weather made err four times as much.
TEST_F(PowerTest, BesideWeatherIsTheShareOfRecordingsOfWhichTheEffectIsNamed) {
  PresentWeather weather = calm_;
  weather.fit.effects = {{&breeze_, {1.0}}};
  weather.fit.score = -80.0;
  weather.excess = 3.0;
  constexpr double kCost = 6.0;
  constexpr double kToAdd = kDiagnosis.search.score_to_add_effect;
  const DayToDay days = Days();
  for (const double share : {2.5, 4.0, 6.0}) {
    const ErrorShift shift{share * metric_.ExpectedSquare(), 0.0};
    const double called = ShareOfDays(shift, [&](double before, double explained, double) {
      const double after = (before - explained) / metric_.ExpectedSquare();
      const LackOfFit lack_of_fit{.before = before / metric_.ExpectedSquare() + weather.excess,
                                  .after = after,
                                  .nominal = std::exp(days.log_nominal),
                                  .median = kDiagnosis.ranking.nominal_median * after};
      EffectFit both = weather.fit;
      both.effects.push_back({&effect_, {1.0}});
      both.score += metric_.Deviance(before - explained, before) + kCost;
      if (both.score >= weather.fit.score - kToAdd) return false;
      return VerdictOf(GapAssessment::kMaterial,
                       Rank({{weather.fit}, {both}, {}}, metric_, lack_of_fit),
                       std::nullopt) == Verdict::kExplained;
    });
    const double stated =
        PowerOf(shift, {{.score = weather.fit.score + kCost}, kToAdd}, weather, days);
    EXPECT_NEAR(called, stated, kTolerance) << "share " << share;
    EXPECT_LE(stated, PowerOf(shift, {{.score = kCost}}, calm_, days)) << "share " << share;
  }
}

TEST_F(PowerTest, TheDaysAreThoseLeftOut) {
  left_out_ = {{std::exp(0.5), std::exp(0.2)}, {std::exp(-0.5), std::exp(0.6)}};
  const DayToDay days = Days();
  EXPECT_NEAR(days.log_nominal, 0.0, 1e-12);
  EXPECT_NEAR(days.noise.log_mean, 0.4, 1e-12);
  EXPECT_NEAR(days.noise.log_sd, std::sqrt(0.08 * 1.5), 1e-12);
  EXPECT_NEAR(days.squared_gap.log_mean, 0.0, 1e-12);
  EXPECT_NEAR(days.squared_gap.log_sd, std::sqrt(0.5 * 1.5), 1e-12);
  EXPECT_TRUE(days.squared_limit.has_value());
}

TEST_F(PowerTest, ASingleReferenceIsGivenAnAssumedScatter) {
  nominal_.log_reduced_chi_squares = {0.3};
  const DayToDay days = Days();
  EXPECT_EQ(days.noise.log_mean, 0.3);
  EXPECT_NEAR(days.noise.log_sd, kDiagnosis.gap.single_recording_sd * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(days.noise.degrees_of_freedom, 1.0);
  EXPECT_FALSE(days.squared_limit.has_value());
}

}  // namespace
}  // namespace telltale
