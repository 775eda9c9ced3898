#include "telltale/core/diagnosis/hypotheses/onset.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"

namespace telltale {
namespace {

/// Windows of which the baseline explains those before `onset` and the hypothesis those from it on:
/// the other one errs there by a squared norm of `square`.
class OnsetTest : public ::testing::Test {
 protected:
  std::optional<Onset> OnsetWith(Eigen::Index onset, double square, std::size_t windows) const {
    const auto all = static_cast<Eigen::Index>(short_.runs.Windows());
    EffectFit fit;
    fit.errors = Eigen::MatrixXd::Zero(short_.runs.Rows(), all);
    Eigen::MatrixXd baseline = fit.errors;
    fit.errors.row(0).head(onset).setConstant(std::sqrt(square));
    baseline.row(0).tail(all - onset).setConstant(std::sqrt(square));
    const Sensitivity recording = testing::SensitivityOfErrors(baseline, 0, 0);
    const NominalBaseline nominal = testing::UnitBaseline(short_.runs.Rows(), 0, 0);
    std::vector<std::size_t> some = EveryWindow(recording);
    some.resize(windows);
    const ResidualMetric metric(nominal, recording, some, false);
    return OnsetOf(fit, {short_.runs, nominal, recording, metric, no_parameters_, no_excitation_});
  }

  double TimeOf(std::size_t window) const { return short_.runs.Of(window).time_s; }

  const testing::ShortRecording short_;
  const std::vector<EffectParameterRef> no_parameters_;
  const ObservedExcitation no_excitation_;
};

TEST_F(OnsetTest, IsTheWindowFromWhichTheHypothesisIsLikelier) {
  const auto onset = OnsetWith(12, 50.0, short_.runs.Windows());
  ASSERT_TRUE(onset.has_value());
  EXPECT_EQ(onset->time_s, TimeOf(12));
  EXPECT_EQ(onset->earliest_s, TimeOf(12));
  EXPECT_EQ(onset->latest_s, TimeOf(12));
}

// A window off costs 3, two windows 6: those within 3.84 of the best are one window either side.
TEST_F(OnsetTest, HasTheIntervalOfChiSquared) {
  const auto onset = OnsetWith(12, 3.0, short_.runs.Windows());
  ASSERT_TRUE(onset.has_value());
  EXPECT_EQ(onset->time_s, TimeOf(12));
  EXPECT_EQ(onset->earliest_s, TimeOf(11));
  EXPECT_EQ(onset->latest_s, TimeOf(13));
}

TEST_F(OnsetTest, IsNoneWhereTheGainIsNoMoreThanTheSearchCosts) {
  EXPECT_FALSE(OnsetWith(12, 2.0, short_.runs.Windows()).has_value());
}

TEST_F(OnsetTest, IsNoneWhereTheHypothesisActsAllAlong) {
  EXPECT_FALSE(OnsetWith(0, 50.0, short_.runs.Windows()).has_value());
}

TEST_F(OnsetTest, IsNoneInFewerThanTwelveWindows) {
  EXPECT_TRUE(OnsetWith(6, 50.0, 12).has_value());
  EXPECT_FALSE(OnsetWith(6, 50.0, 11).has_value());
}

}  // namespace
}  // namespace telltale
