#include "telltale/core/diagnosis/hypotheses/power.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/student_t_distribution.hpp>

#include "support/hand_made_diagnosis.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"
#include "telltale/core/diagnosis/hypotheses/score_test.hpp"
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

// ---- the equation, on errors drawn from it ------------------------------------------------------

class PowerTest : public ::testing::Test {
 protected:
  PowerTest() { nominal_.log_reduced_chi_squares = {-0.2, 0.1, 0.1}; }

  /// How many of `trials` recordings show as a gap that an effect of this noncentrality moves along
  /// one direction, by the criteria of AssessGap.
  int Shown(double noncentrality, double cost, int trials) const {
    const NoiseLevels noise = NoiseLevelsOf(nominal_);
    RandomEngine engine(20);
    boost::random::normal_distribution<double> normal;
    boost::random::student_t_distribution<double> student(noise.degrees_of_freedom);
    int shown = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const double scale = std::exp(noise.log_mean + noise.log_sd * student(engine));
      Eigen::VectorXd errors(static_cast<Eigen::Index>(metric_.ExpectedSquare()));
      for (double& error : errors) error = std::sqrt(scale) * normal(engine);
      errors[0] += std::sqrt(noncentrality);
      const double before = errors.squaredNorm();
      const double after = before - errors[0] * errors[0];
      const double score = metric_.Deviance(after, before) + cost;
      const LackOfFit lack_of_fit{before / metric_.ExpectedSquare(), 1.0, std::exp(noise.log_mean),
                                  0.0};
      shown += AssessGap(0.0, 0.0, 1.0, score, lack_of_fit) == GapAssessment::kMaterial ? 1 : 0;
    }
    return shown;
  }

  const testing::ShortRecording short_;
  NominalBaseline nominal_ = testing::UnitBaseline(short_.runs.Rows(), 0, 0);
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
};

TEST_F(PowerTest, IsTheShareOfRecordingsThatShow) {
  constexpr int kTrials = 2000;
  for (const double cost : {1.0, 6.0, 60.0}) {
    for (const double share : {0.3, 0.8, 1.2}) {
      const double noncentrality = share * metric_.ExpectedSquare();
      const double power = PowerOf(noncentrality, cost, metric_, NoiseLevelsOf(nominal_));
      // The nodes over the noise of a day leave half a node of a fifteenth.
      const auto shown = static_cast<double>(Shown(noncentrality, cost, kTrials)) / kTrials;
      EXPECT_NEAR(shown, power, 0.5 / 15.0 + 0.02) << "cost " << cost << ", share " << share;
    }
  }
}

TEST_F(PowerTest, GrowsWithTheEffectAndFallsWithTheCost) {
  const NoiseLevels noise = NoiseLevelsOf(nominal_);
  const double expected = metric_.ExpectedSquare();
  EXPECT_LT(PowerOf(0.5 * expected, 5.0, metric_, noise),
            PowerOf(0.9 * expected, 5.0, metric_, noise));
  EXPECT_LE(PowerOf(0.5 * expected, 9.0, metric_, noise),
            PowerOf(0.5 * expected, 5.0, metric_, noise));
}

TEST_F(PowerTest, ASingleReferenceIsGivenAnAssumedScatter) {
  nominal_.log_reduced_chi_squares = {0.3};
  const NoiseLevels noise = NoiseLevelsOf(nominal_);
  EXPECT_EQ(noise.log_mean, 0.3);
  EXPECT_NEAR(noise.log_sd, kDiagnosis.gap.single_recording_sd * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(noise.degrees_of_freedom, 1.0);
}

// ---- simulated recordings -----------------------------------------------------------------------

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
    const Sensitivity sensitivity = SensitivityOf(runs, nominal_->boat, model_, parameter_refs_, 2);
    const ResidualMetric metric(*nominal_, sensitivity, EveryWindow(sensitivity), false);
    const FrequencyResponse no_response({}, runs, nominal_->boat, sensitivity.errors, 1);
    return visit(
        DiagnosisProblem{runs, *nominal_, sensitivity, metric, parameter_refs_, no_response});
  }

  bool Shows(const PreparedDataset& recording) const {
    return Of(recording, [&](const DiagnosisProblem& problem) {
      const ResidualMetric& metric = problem.metric;
      const EffectFit fit = FitEffects(
          ErrorModelOf(problem.runs, nominal_->boat), metric, {effect_},
          StartsOf(*effect_, metric, problem.recording.errors, problem.recording, parameter_refs_));
      const LackOfFit lack_of_fit{metric.ReducedChiSquare(metric.Whiten(problem.recording.errors)),
                                  1.0, std::exp(NoiseLevelsOf(*nominal_).log_mean), 0.0};
      return AssessGap(0.0, 0.0, 1.0, fit.score + kNominalGain, lack_of_fit) ==
             GapAssessment::kMaterial;
    });
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
    return DetectableSizesOf(*effect_, problem, kNominalGain);
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

}  // namespace
}  // namespace telltale
