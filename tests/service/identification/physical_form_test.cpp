#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using LivePhysicalForm = ServiceTest;

TEST_F(LivePhysicalForm, IsTheDefaultIdentifiedPublishedAndKept) {
  ConfigureIdentification("");
  const auto file = folder_.Path() / "model.json";
  {
    const auto daemon = StartDaemon();
    Replay(SimulatedRecording(testing::StableBoat(), 0.0, 90.0, 4));
    const auto identify =
        Start({"identify", "--vehicle-id", kVehicleId, "--out", file, "--timeout", "500"});
    ASSERT_EQ(identify->Wait(), 0) << identify->output();
    const auto model = ParseModelJson(*ReadFile(file));
    ASSERT_TRUE(model) << model.error().Message();
    EXPECT_EQ(model->structure, Structure::kFossen);
    ASSERT_TRUE(model->physical);
    EXPECT_EQ(model->physical->parameters.size(), kFossenParameters);
  }
  const auto daemon = StartDaemon();
  const auto watch = Start({"watch", "--vehicle-id", kVehicleId, "--count", "1", "--json"});
  ASSERT_EQ(watch->Wait(), 0) << watch->output();
  EXPECT_THAT(watch->output(), AllOf(HasSubstr("\"FOSSEN\""), HasSubstr("\"Xuu\"")));
}

TEST_F(LivePhysicalForm, IsChosenByTheDataWhereTheConfigurationSaysSo) {
  ConfigureIdentification("structure: \"auto\"");
  const auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 90.0, 4));
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId, "--timeout", "500"});
  ASSERT_EQ(identify->Wait(), 0) << identify->output();
  // A minute and a half holds fewer than the ten free runs that free coefficients need.
  EXPECT_THAT(identify->output(), HasSubstr("Structure chosen: physical form"));
}

TEST_F(LivePhysicalForm, LeavesAChoiceByTheDataToTheConfiguration) {
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId, "--structure", "auto"});
  EXPECT_EQ(identify->Wait(), 2);
  EXPECT_THAT(identify->output(), HasSubstr("the daemon's configuration"));
}

TEST_F(LivePhysicalForm, TakesNoOptionOfFreeCoefficients) {
  const auto identify = Start(
      {"identify", "--vehicle-id", kVehicleId, "--structure", "fossen", "--estimator", "weak-iv"});
  EXPECT_EQ(identify->Wait(), 2);
  EXPECT_THAT(identify->output(), HasSubstr("belongs to --structure static and dynamic"));
}

}  // namespace
}  // namespace telltale
