#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"
#include "support/unlisted_effects.hpp"

namespace telltale {
namespace {

ResidualMetric UnitMetricOf(const Eigen::MatrixXd& errors) {
  const Sensitivity recording = testing::SensitivityOfErrors(errors, 0, 0);
  return {testing::UnitBaseline(errors.rows(), 0, 0), recording, EveryWindow(recording), false};
}

EffectFit FitOf(const char* effect, const Eigen::MatrixXd& errors) {
  EffectFit fit;
  fit.effects = {{FindEffect(effect), {}}};
  fit.errors = errors;
  fit.square = errors.squaredNorm();
  return fit;
}

// n / 2 ln(1 + |y1 - y2|^2 / Q), n half an observation a window, Q the smaller square.
TEST(Distance, IsTheExpectedLogEvidenceInClosedForm) {
  const Eigen::MatrixXd one = testing::Pattern(3, 20, 0.7);
  const Eigen::MatrixXd other = 2.0 * testing::Pattern(3, 20, 1.9);
  const double expected =
      0.5 * 10.0 * std::log(1.0 + (one - other).squaredNorm() / one.squaredNorm());
  EXPECT_NEAR(Distance(FitOf("wind", one), FitOf("current", other), UnitMetricOf(one)), expected,
              1e-9);
}

TEST(Distance, IsZeroBetweenHypothesesThatLeaveTheSameErrors) {
  const Eigen::MatrixXd errors = testing::Pattern(3, 20, 0.7);
  EXPECT_EQ(Distance(FitOf("wind", errors), FitOf("current", errors), UnitMetricOf(errors)), 0.0);
}

TEST(Distance, IsInfiniteWhereStochasticEffectsDiffer) {
  const Eigen::MatrixXd errors = testing::Pattern(3, 20, 0.7);
  EXPECT_EQ(Distance(FitOf("wind", errors), FitOf("waves", errors), UnitMetricOf(errors)),
            std::numeric_limits<double>::infinity());
}

TEST(BestHypothesis, HasTheLowestScoreOfSinglesAndCombinations) {
  Hypotheses hypotheses;
  hypotheses.singles.resize(1);
  hypotheses.singles[0].score = -5.0;
  EXPECT_EQ(&BestHypothesis(hypotheses), &hypotheses.singles[0]);
  hypotheses.combined.resize(1);
  hypotheses.combined[0].score = -4.0;
  EXPECT_EQ(&BestHypothesis(hypotheses), &hypotheses.singles[0]);
  hypotheses.combined[0].score = -30.0;
  EXPECT_EQ(&BestHypothesis(hypotheses), &hypotheses.combined[0]);
}

// Weather is there on most days, a second kind of it on few.
TEST(ScoreToAdd, IsLessOfTheFirstWeatherAlone) {
  const Eigen::MatrixXd errors = testing::Pattern(3, 20, 0.7);
  const EffectFit fault = FitOf("heading_bias", errors);
  const EffectFit weather = FitOf("current", errors);
  const double of_second_fault = ScoreToAdd(*FindEffect("thrust_gain"), fault);
  EXPECT_LT(ScoreToAdd(*FindEffect("current"), fault), of_second_fault);
  EXPECT_EQ(ScoreToAdd(*FindEffect("waves"), weather), of_second_fault);
  EXPECT_EQ(ScoreToAdd(*FindEffect("thrust_gain"), weather), of_second_fault);
}

/// Waves of that score, and three effects that are likelier or less likely.
std::vector<EffectFit> SinglesWithWaves(double score) {
  const Eigen::MatrixXd errors = testing::Pattern(3, 20, 0.7);
  std::vector<EffectFit> singles;
  for (const char* effect : {"wind", "current", "heading_bias", "waves"}) {
    singles.push_back(FitOf(effect, errors));
    singles.back().score = static_cast<double>(singles.size()) - 40.0;
  }
  singles.back().score = score;
  return singles;
}

std::vector<std::string> NamesOfSeeds(const std::vector<EffectFit>& singles) {
  std::vector<std::string> names;
  for (const EffectFit& seed : SeedsOf(singles)) names.push_back(seed.Names().front());
  return names;
}

TEST(SeedsOf, AreTheBestSinglesAndWavesWithEvidence) {
  EXPECT_THAT(NamesOfSeeds(SinglesWithWaves(-20.0)),
              ::testing::UnorderedElementsAre("wind", "current", "waves"));
}

TEST(SeedsOf, LeaveOutWavesWithoutEvidence) {
  EXPECT_THAT(NamesOfSeeds(SinglesWithWaves(3.0)),
              ::testing::UnorderedElementsAre("wind", "current"));
}

/// A search by a baseline whose errors are independent with the mean squares of a nominal
/// recording.
class SearchTest : public ::testing::Test {
 protected:
  static Hypotheses Found(const std::vector<ModelledEffect>& effects,
                          std::span<const Effect* const> library, const Hypotheses& known = {}) {
    const testing::ShortRecording nominal_recording;
    const testing::ShortRecording short_recording(120.0, effects);
    const auto parameter_refs = EffectParameterRefsOf(library);
    const FreeRuns& runs = short_recording.runs;
    const UncertainModel& model = short_recording.model;
    const auto coefficients = static_cast<Eigen::Index>(model.free.size());
    NominalBaseline nominal =
        testing::UnitBaseline(runs.Rows(), coefficients, std::ssize(parameter_refs));
    const Eigen::MatrixXd errors = nominal_recording.runs.Errors(nominal.boat);
    nominal.covariance = errors.rowwise().squaredNorm().asDiagonal();
    nominal.covariance /= static_cast<double>(errors.cols());
    nominal.days = {SensitivityOf(nominal_recording.runs, {nominal.boat, nominal.coefficients},
                                  model, parameter_refs, 2)};
    const Sensitivity recording =
        SensitivityOf(runs, {nominal.boat, nominal.coefficients}, model, parameter_refs, 2);
    const ResidualMetric metric(nominal, recording, EveryWindow(recording), false);
    ObservedExcitation no_excitation;
    no_excitation.scatter = Eigen::MatrixXd::Zero(runs.Rows(), runs.Rows());
    no_excitation.nominal = {AccelerationSpectraOf(nominal_recording.dataset, nominal.boat)};
    return Search(
        {runs, nominal, recording, metric, parameter_refs, no_excitation}, library, 2, 2,
        [](double) {}, known);
  }

  static Hypotheses FoundAmongThree(const std::vector<ModelledEffect>& effects,
                                    const Hypotheses& known = {}) {
    return Found(effects,
                 std::vector{FindEffect("thruster_lag"), FindEffect("heading_bias"),
                             FindEffect("thrust_gain")},
                 known);
  }
};

TEST_F(SearchTest, FindsTheOneEffectThatActs) {
  const Hypotheses found = FoundAmongThree({{FindEffect("thrust_gain"), {0.3}}});
  ASSERT_FALSE(found.singles.empty());
  EXPECT_EQ(found.singles.front().Names(), std::vector<std::string>{"thrust_gain"});
  EXPECT_NEAR(found.singles.front().effects[0].values[0], 0.3, 0.05);
  EXPECT_TRUE(found.combined.empty());
}

TEST_F(SearchTest, FindsBothEffectsThatActTogether) {
  const Hypotheses found =
      FoundAmongThree({{FindEffect("thrust_gain"), {0.3}}, {FindEffect("heading_bias"), {0.12}}});
  ASSERT_FALSE(found.combined.empty());
  EXPECT_THAT(found.combined.front().Names(),
              ::testing::UnorderedElementsAre("thrust_gain", "heading_bias"));
}

TEST_F(SearchTest, FindsTheSameAgainFromWhatIsKnown) {
  const std::vector<ModelledEffect> acting = {{FindEffect("thrust_gain"), {0.3}}};
  const Hypotheses found = FoundAmongThree(acting);
  const Hypotheses again = FoundAmongThree(acting, found);
  EXPECT_EQ(again.singles.front().Names(), found.singles.front().Names());
  EXPECT_NEAR(again.singles.front().score, found.singles.front().score,
              1e-3 * std::abs(found.singles.front().score));
}

// Of a nominal recording no effect is known to matter, and one hypothesis is left to conclude from.
TEST_F(SearchTest, FitsNoneAgainThatPromisesNothingButTheFirst) {
  const Hypotheses found = FoundAmongThree({});
  ASSERT_EQ(found.singles.size(), 3u);
  const Hypotheses again = FoundAmongThree({}, found);
  EXPECT_EQ(again.singles.size(), 1u);
  EXPECT_TRUE(again.combined.empty());
}

/// Gusts that move nothing, and notice whether they are asked for more than a slope.
class IdleGusts final : public Effect {
 public:
  IdleGusts()
      : Effect({.name = "idle_gusts",
                .title = "",
                .equation = "",
                .source = "",
                .parameters = {{"speed", "m/s", kTypical, -25.0, 25.0}},
                .settled_by = "",
                .hook = Hook::kAcceleration,
                .turbulence_intensity = 0.2,
                .turbulence_time_s = 8.0}) {}
  std::string Describe(EffectValues) const override { return "idle gusts"; }
  NuDot AddedAcceleration(EffectValues values, const InstantState&) const override {
    if (values[0] != kTypical) is_fitted_ = true;
    return {};
  }

  bool IsFittedBy(const std::function<void()>& search) const {
    is_fitted_ = false;
    search();
    return is_fitted_;
  }

 private:
  static constexpr double kTypical = 4.0;
  mutable std::atomic<bool> is_fitted_ = false;
};

// Gusts may show where their mean does not, so that the score test spares no fit.
TEST_F(SearchTest, FitsGustsAgainOnlyWhereTheyAreKnownToMatter) {
  const IdleGusts gusts;
  const std::vector library = {FindEffect("thrust_gain"), static_cast<const Effect*>(&gusts)};
  const std::vector<ModelledEffect> acting = {{FindEffect("thrust_gain"), {0.3}}};
  Hypotheses found;
  EXPECT_TRUE(gusts.IsFittedBy([&] { found = Found(acting, library); }));
  EXPECT_FALSE(gusts.IsFittedBy([&] { Found(acting, library, found); }));
  EffectFit both = found.singles.front();
  both.effects.push_back({&gusts, {0.0}});
  found.combined = {both};
  EXPECT_TRUE(gusts.IsFittedBy([&] { Found(acting, library, found); }));
}

// The recording alone is said to have no peak, as where an effect covers it.
TEST_F(SearchTest, FindsWavesWhosePeakShowsBesideAnEffectAlone) {
  const testing::Swell swell;
  const Hypotheses found = Found({{&swell, {}}, {FindEffect("thrust_gain"), {0.3}}},
                                 std::vector{FindEffect("thrust_gain"), FindEffect("waves")});
  ASSERT_FALSE(found.combined.empty());
  EXPECT_THAT(found.combined.front().Names(),
              ::testing::UnorderedElementsAre("thrust_gain", "waves"));
}

/// Commands cut off at 1.2 less its size: at its typical size of 0.2 it does nothing.
class DeepCut final : public Effect {
 public:
  DeepCut()
      : Effect({.name = "deep_cut",
                .title = "",
                .equation = "",
                .source = "",
                .parameters = {{"cut", "1", 0.2, 0.0, 1.1}},
                .settled_by = "",
                .hook = Hook::kCommand}) {}
  std::string Describe(EffectValues) const override { return "deep cut"; }
  double Command(EffectValues values, Side, double delta) const override {
    return std::clamp(delta, values[0] - 1.2, 1.2 - values[0]);
  }
};

/// All effects that are not stochastic.
std::vector<const Effect*> DeterministicLibrary() {
  std::vector<const Effect*> library;
  std::ranges::copy_if(EffectLibrary(), std::back_inserter(library),
                       [](const Effect* effect) { return !effect->IsStochastic(); });
  return library;
}

// More effects than are fitted in full promise more than the mean of rare spells does.
TEST_F(SearchTest, FitsSpellsWhateverTheScoreTestSays) {
  const Hypotheses found = Found({{FindEffect("thruster_lag"), {0.6}}}, DeterministicLibrary());
  const auto spells = std::ranges::find_if(found.singles, [](const EffectFit& fit) {
    return fit.effects.front().effect->IsIntermittent();
  });
  EXPECT_NE(spells, found.singles.end());
}

// The score test there ranks it behind everything that moves the boat at all, of which more is
// known than is fitted in full.
TEST_F(SearchTest, FindsWhatShowsAboveAThresholdAlone) {
  const DeepCut deep_cut;
  std::vector<const Effect*> library = DeterministicLibrary();
  std::erase(library, FindEffect("thruster_saturation"));
  library.push_back(&deep_cut);
  const Hypotheses found = Found({{&deep_cut, {0.5}}}, library);
  EXPECT_EQ(found.singles.front().Names(), std::vector<std::string>{"deep_cut"});
  EXPECT_NEAR(found.singles.front().effects[0].values[0], 0.5, 0.05);
}

}  // namespace
}  // namespace telltale
