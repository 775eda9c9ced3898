#include "telltale/core/validation/structure_choice.hpp"

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

IdentifyOptions TwoThreads() {
  IdentifyOptions options;
  options.threads = 2;
  return options;
}

/// Ten minutes of a boat whose 35 coefficients lie outside the physical form.
Recording OfFreeCoefficients() {
  const auto track =
      Simulate(YellowfishTwin(), {}, SampleMission(1), kSampleMissionDurationS, 0.02);
  return Measure(track, YellowfishVehicle(), {});
}

Recording FirstOfFreeCoefficients(double duration_s) {
  const Recording recording = OfFreeCoefficients();
  const double start_s = recording.gnss.front().time_s;
  return Between(recording, start_s, start_s + duration_s);
}

StructureChoice ChoiceOfTheFirst(double duration_s, const Progress& progress = {}) {
  return ChooseStructure(FirstOfFreeCoefficients(duration_s), YellowfishVehicle(), TwoThreads(),
                         progress);
}

std::vector<std::string> StagesOfTheFirst(double duration_s) {
  std::vector<std::string> stages;
  std::mutex mutex;
  ChoiceOfTheFirst(duration_s, [&](std::string_view stage, double) {
    const std::lock_guard lock(mutex);
    stages.emplace_back(stage);
  });
  return stages;
}

TEST(ChooseStructure, KeepsFreeCoefficientsThatPredictWhatThePhysicalFormCannot) {
  const StructureChoice choice =
      ChooseStructure(OfFreeCoefficients(), YellowfishVehicle(), TwoThreads());
  EXPECT_EQ(choice.structure, Structure::kStaticQuadratic);
  EXPECT_THAT(choice.reason, StartsWith("free coefficients, since"));
  ASSERT_TRUE(choice.score);
  EXPECT_NEAR(choice.score->held_out_s, 0.2 * kSampleMissionDurationS, 1.0);
}

/// The same boat: what ten free runs cannot show is left to the form with fewer unknowns.
TEST(ChooseStructure, TakesThePhysicalFormOfARecordingThatIsShort) {
  const StructureChoice choice = ChoiceOfTheFirst(90.0);
  EXPECT_EQ(choice.structure, Structure::kFossen);
  EXPECT_THAT(choice.reason, HasSubstr("too short"));
  ASSERT_TRUE(choice.score);
  EXPECT_LT(choice.score->metrics.free_run.front().windows, 10u);
}

/// Free coefficients, which take longer to score, cannot replace it there.
TEST(ChooseStructure, ScoresFreeCoefficientsWhereTenRunsFitAlone) {
  EXPECT_THAT(StagesOfTheFirst(190.0), Not(Contains("scoring free coefficients")));
  EXPECT_THAT(StagesOfTheFirst(210.0), Contains("scoring free coefficients"));
}

TEST(ChooseStructure, TakesThePhysicalFormWhereNothingCanBeScored) {
  const StructureChoice choice = ChoiceOfTheFirst(10.0);
  EXPECT_EQ(choice.structure, Structure::kFossen);
  EXPECT_FALSE(choice.score);
}

TEST(IdentifyInChosenStructure, RefusesARecordingWithoutFixes) {
  Recording recording = OfFreeCoefficients();
  recording.gnss.clear();
  EXPECT_FALSE(IdentifyInChosenStructure(recording, YellowfishVehicle(), TwoThreads()));
}

/// Free coefficients err by less than a tenth of constant velocity here: little is left to gain.
TEST(ChooseStructure, SparesThePhysicalFormWhereLittleIsToBeGained) {
  EXPECT_THAT(StagesOfTheFirst(kSampleMissionDurationS), ElementsAre("scoring free coefficients"));
}

TEST(IdentifyInChosenStructure, GivesTheSameModelWithAnyNumberOfThreads) {
  const Recording part = FirstOfFreeCoefficients(90.0);
  const auto of_one = IdentifyInChosenStructure(part, YellowfishVehicle(), {});
  const auto of_two = IdentifyInChosenStructure(part, YellowfishVehicle(), TwoThreads());
  ASSERT_TRUE(of_one && of_two);
  ASSERT_TRUE(of_one->model.physical && of_two->model.physical);
  EXPECT_EQ(of_one->model.physical->covariance, of_two->model.physical->covariance);
  EXPECT_EQ(of_one->model.provenance.structure_choice, of_two->model.provenance.structure_choice);
}

/// The score is that of a model of the first part alone, and costs the other model nothing.
TEST(IdentifyInGivenStructure, ScoresThePhysicalFormBesideItWithAnyNumberOfThreads) {
  const Recording part = FirstOfFreeCoefficients(90.0);
  IdentifyOptions options = TwoThreads();
  options.regression.structure = Structure::kFossen;
  const auto of_two = IdentifyInGivenStructure(part, YellowfishVehicle(), options);
  options.threads = 1;
  const auto of_one = IdentifyInGivenStructure(part, YellowfishVehicle(), options);
  ASSERT_TRUE(of_one && of_two && of_one->score && of_two->score);
  EXPECT_EQ(of_one->model.physical->covariance, of_two->model.physical->covariance);
  EXPECT_EQ(of_one->score->metrics.free_run.front().position_rmse_m,
            of_two->score->metrics.free_run.front().position_rmse_m);
  EXPECT_NEAR(of_two->score->held_out_s, 0.2 * 90.0, 1.0);
}

}  // namespace
}  // namespace telltale
