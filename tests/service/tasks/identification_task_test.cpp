#include "telltale/service/tasks/identification_task.hpp"

#include <string_view>

#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/validation/structure_choice.hpp"
#include "telltale/service/tasks/identification_options.hpp"

namespace telltale {
namespace {

// The structure is chosen by a model of the first part of the data and its errors over the rest.
TEST(IdentificationTask, TakesTheVerdictFromTheScoreThatChoseTheStructure) {
  IdentificationTask task;
  task.vehicle = YellowfishVehicle();
  task.recording = SimulatedRecording(YellowfishTwin(), 0.0, 50.0, 3);
  task.settings.bootstrap_replicates = 0;
  const Progress ignored = [](std::string_view, double) {};
  const IdentifyOptions options = OptionsOf(task.request, task.settings);
  const auto made = IdentifyInChosenStructure(task.recording, task.vehicle, options, ignored);
  ASSERT_TRUE(made);
  ASSERT_TRUE(made->score);
  ASSERT_EQ(made->model.structure, Structure::kFossen);
  const Promotion expected =
      AssessPromotion(task.recording, task.vehicle, made->model, options, made->score);
  ASSERT_EQ(expected.verdict, PromotionVerdict::kWarn) << "a verdict with the errors as its reason";
  const auto computed = Compute(task, ignored);
  ASSERT_TRUE(computed);
  EXPECT_EQ(computed->promotion, expected);
}

}  // namespace
}  // namespace telltale
