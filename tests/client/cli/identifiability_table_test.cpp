#include "telltale/client/cli/identifiability_table.hpp"

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/identifiability.hpp"
#include "support/made_up_identifications.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/cli/coverage_check_table.hpp"
#include "telltale/client/cli/model_table.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(IdentifiabilityTableTest, ShowsHowSeparableCoefficientsAre) {
  const std::string text = IdentifiabilityTable(WithIdentifiability(MadeUpIdentification()));
  // The largest finite inflation of SURGE is its ninth, 1 + 8 / 7.
  EXPECT_THAT(text, AllOf(HasSubstr("SURGE"), HasSubstr("20.0"), HasSubstr("2.14 of r:d"),
                          HasSubstr("u|u| - 0.3 rr"), HasSubstr("33")));
}

TEST(IdentifiabilityTableTest, AdvisesWithWhatIsToBeExpected) {
  std::string text = IdentifiabilityTable(WithIdentifiability(MadeUpIdentification()));
  text = std::regex_replace(text, std::regex("\\s+"), " ");
  EXPECT_THAT(text, AllOf(HasSubstr("zigzag for 120 s would shrink YAW r|r| from ±40 % to ±13 %"),
                          HasSubstr("SURGE vr from unknown to ±0.12"),
                          HasSubstr("-> changing sides every 6 s")));
  // A manoeuvre that would do nothing is not advised.
  EXPECT_THAT(text, Not(HasSubstr("spins")));
}

TEST(IdentifiabilityTableTest, SaysHowOftenBoundsHeld) {
  std::string text = CoverageTable(WithIdentifiability(MadeUpIdentification()));
  text = std::regex_replace(text, std::regex("\\s+"), " ");
  EXPECT_THAT(text, AllOf(HasSubstr("0 of 98"), HasSubstr("34 of 98"), HasSubstr("93.8 % held"),
                          HasSubstr("98 of 100 simulated replicates"), HasSubstr("ellipsoid"),
                          HasSubstr("if the model is true")));
}

TEST(IdentifiabilityTableTest, IsLeftOutWhereThereIsNone) {
  EXPECT_EQ(IdentifiabilityTable(MadeUpIdentification()), "");
  EXPECT_EQ(CoverageTable(MadeUpIdentification()), "");
  EXPECT_THAT(ModelTable(MadeUpIdentification()), Not(HasSubstr("coverage check")));
}

/// A log of the Yellowfish twin; bounds from residuals keep a repeat to milliseconds.
class CheckCoverageCommand : public testing::Test {
 protected:
  CheckCoverageCommand() {
    folder.Write("boat.textproto", PrintVehicle(YellowfishVehicle()));
    const auto track =
        Simulate(YellowfishTwin(), {}, SampleMission(1), kSampleMissionDurationS, 0.02);
    WriteTelemetryLog(folder.Path() / "log", Measure(track, YellowfishVehicle(), {}));
  }

  CommandOutcome WithCoverageCheck(const std::string& replicates) const {
    return Telltale({"identify", "--log", (folder.Path() / "log").string(), "--vehicle",
                     (folder.Path() / "boat.textproto").string(), "--bootstrap", "0",
                     "--check-coverage", replicates, "--out",
                     (folder.Path() / "model.json").string()});
  }

  TemporaryFolder folder;
};

TEST_F(CheckCoverageCommand, PrintsAndWritesTheCoverageCheck) {
  const CommandOutcome outcome = WithCoverageCheck("10");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("bounds held"), HasSubstr("of 10 simulated replicates"),
                                 HasSubstr("excitation"), HasSubstr("condition")));
  const auto model = ParseModelJson(TextOfFile(folder.Path() / "model.json"));
  ASSERT_TRUE(model) << model.error().Message();
  ASSERT_TRUE(model->coverage_check.has_value());
  EXPECT_EQ(model->coverage_check->replicates_requested, 10u);
  EXPECT_EQ(model->excitation.size(), 3u);
}

TEST_F(CheckCoverageCommand, ANumberOutOfRangeIsAUsageErrorThatNamesTheRange) {
  for (const char* replicates : {"1", "1001", "-5", "many"}) {
    const CommandOutcome outcome = WithCoverageCheck(replicates);
    EXPECT_EQ(outcome.exit_code, 2) << replicates;
    EXPECT_THAT(outcome.err,
                testing::AnyOf(HasSubstr("[10, 1000]"), HasSubstr("--check-coverage")));
  }
}

}  // namespace
}  // namespace telltale
