#include "telltale/core/diagnosis/hypotheses/detectable_size.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/hand_made_diagnosis.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"
#include "telltale/core/diagnosis/hypotheses/score_test.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

constexpr double kPower = kDiagnosis.testability.power;

/// What a count of `trials` is within, of all but one in ten thousand repetitions, where each
/// happens with `probability`.
auto IsBinomial(double trials, double probability) {
  constexpr double kTail = 5e-5;
  double least = 0.0;
  while (BinomialUpperBound(trials, least, kTail) < probability) ++least;
  double most = trials;
  while (BinomialLowerBound(trials, most, kTail) > probability) --most;
  return AllOf(Ge(least), Le(most));
}

constexpr double kDurationS = 120.0;

/// The stable boat under the same commands each time, with other sensor noise.
PreparedDataset SameManoeuvres(const std::vector<ModelledEffect>& effects,
                               std::uint64_t noise_seed) {
  const AugmentedModel boat{testing::StableBoat(), effects};
  SensorOptions sensors;
  sensors.seed = noise_seed;
  const auto track = Simulate(boat, testing::VariedCommands(kDurationS, 40), kDurationS, 0.05);
  PrepareOptions options;
  options.sampling_period_s = 0.2;
  return Prepare(Measure(track, boat, testing::StableBoatVehicle(), sensors),
                 testing::StableBoatVehicle(), options)
      .value();
}

/// Diagnosis of recordings against one nominal baseline, as far as the gate.
class GateTest : public ::testing::Test {
 protected:
  GateTest() {
    for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6})
      references_.push_back(SameManoeuvres({}, seed));
    for (const PreparedDataset& reference : references_) {
      reference_runs_.emplace_back(reference, model_.model, kDiagnosis.horizons.main_s);
    }
    nominal_ = LearnNominalBaseline(reference_runs_, model_, parameter_refs_, 2);
  }

  /// Calls `visit` with the problem of a recording.
  template <class Visit>
  auto Of(const PreparedDataset& recording, Visit visit) const {
    const FreeRuns runs(recording, model_.model, kDiagnosis.horizons.main_s);
    const Sensitivity sensitivity =
        SensitivityOf(runs, {nominal_->boat, nominal_->coefficients}, model_, parameter_refs_, 2);
    const ResidualMetric metric(*nominal_, sensitivity, EveryWindow(sensitivity), false);
    const ObservedExcitation no_excitation;
    return visit(
        DiagnosisProblem{runs, *nominal_, sensitivity, metric, parameter_refs_, no_excitation});
  }

  bool Shows(const PreparedDataset& recording) const {
    return Of(recording, [&](const DiagnosisProblem& problem) {
      const ResidualMetric& metric = problem.metric;
      const EffectFit fit = FitEffects(
          ErrorModelOf(problem.runs, nominal_->boat), metric, {effect_},
          StartsOf(*effect_, metric, problem.recording.errors, problem.recording, parameter_refs_));
      const LackOfFit lack_of_fit{metric.ReducedChiSquare(metric.Whiten(problem.recording.errors)),
                                  1.0, std::exp(DayToDayOf(*nominal_, {}).log_nominal), 0.0};
      return AssessGap(0.0, 0.0, 1.0, fit.score + kNominalGain, lack_of_fit) ==
             GapAssessment::kMaterial;
    });
  }

  double SquaredGapOf(const PreparedDataset& recording, const Eigen::VectorXd& scale) const {
    const FreeRuns runs(recording, model_.model, kDiagnosis.horizons.main_s);
    return SquaredGaps(runs.Errors(nominal_->boat), scale, kAllChannels).mean();
  }

  static constexpr double kNominalGain = 1.0;
  const Effect* effect_ = FindEffect("thruster_imbalance");
  const std::vector<const Effect*> library_ = {effect_};
  const std::vector<EffectParameterRef> parameter_refs_ = EffectParameterRefsOf(library_);
  const UncertainModel model_ = UncertainModelOf(testing::KnownStableBoat()).value();
  std::vector<PreparedDataset> references_;
  std::vector<FreeRuns> reference_runs_;
  std::optional<NominalBaseline> nominal_;
};

TEST_F(GateTest, AnEffectOfTheDetectableSizeShowsAsOftenAsStated) {
  const auto sizes = Of(SameManoeuvres({}, 100), [&](const DiagnosisProblem& problem) {
    return DetectableSizesOf(*effect_, problem, {problem.metric},
                             NoiseFloorOf(reference_runs_, nominal_->boat).scale,
                             DayToDayOf(*nominal_, {}), kNominalGain);
  });
  ASSERT_EQ(sizes.size(), 1U);
  ASSERT_TRUE(sizes[0].size.has_value());
  constexpr int kTrials = 60;
  double shown = 0.0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const double sign = trial % 2 == 0 ? 1.0 : -1.0;
    shown += Shows(SameManoeuvres({{effect_, {sign * *sizes[0].size}}}, 1000 + trial)) ? 1.0 : 0.0;
  }
  EXPECT_THAT(shown, IsBinomial(kTrials, kPower)) << "at a size of " << *sizes[0].size;
}

// A compass that is turned against its error of the day makes less of a gap. Days leave too much
// for a cause to be named, so that the gap alone decides: that of nine days of ten.
TEST_F(GateTest, AnEffectOfTheDetectableSizeMakesItsGapOnThisRecordingInEitherSense) {
  const Effect* compass = FindEffect("heading_bias");
  constexpr double kErrorOfTheDay = 0.01;
  constexpr std::uint64_t kNoise = 100;
  const DayToDay days =
      DayToDayOf(*nominal_, {{80.0, 20.0}, {81.0, 22.0}, {79.0, 18.0}, {80.0, 25.0}});
  const Eigen::VectorXd scale = NoiseFloorOf(reference_runs_, nominal_->boat).scale;
  const PreparedDataset recording = SameManoeuvres({{compass, {kErrorOfTheDay}}}, kNoise);
  const double own = SquaredGapOf(recording, scale);
  ASSERT_LT(own, *days.squared_limit);
  const auto sizes = Of(recording, [&](const DiagnosisProblem& problem) {
    return DetectableSizesOf(*compass, problem, {problem.metric}, scale, days, kNominalGain);
  });
  ASSERT_EQ(sizes.size(), 1U);
  ASSERT_TRUE(sizes[0].size.has_value());
  const auto added = [&](double turn) {
    return SquaredGapOf(SameManoeuvres({{compass, {kErrorOfTheDay + turn}}}, kNoise), scale) - own;
  };
  const double with = added(*sizes[0].size);
  const double against = added(-*sizes[0].size);
  EXPECT_GT(with, 1.2 * against) << "otherwise the day's own error hardly counts";
  // The size is told to 1 %, its square to 2; the tenth of fifteen days stands for a tenth.
  EXPECT_NEAR(against, *days.squared_limit - days.squared_gap.Quantile(0.1), 0.05 * against);
}

}  // namespace
}  // namespace telltale
