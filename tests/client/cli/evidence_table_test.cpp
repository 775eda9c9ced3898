#include "telltale/client/cli/evidence_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/evidence.hpp"
#include "support/identifications.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/cli/model_table.hpp"
#include "telltale/client/recording/telemetry_log.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/yellowfish.hpp"
#include "telltale/idl/codec/model_json.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(EvidenceTable, SaysHowFarCoefficientsAreToldApart) {
  const std::string text = ExcitationTable(WithEvidence(MadeUpIdentification()));
  // The largest finite inflation of SURGE is its ninth, 1 + 8 / 7.
  EXPECT_THAT(text, AllOf(HasSubstr("SURGE"), HasSubstr("20.0"), HasSubstr("2.14 of r:d"),
                          HasSubstr("u|u| - 0.3 rr"), HasSubstr("33")));
}

TEST(EvidenceTable, AdvisesWithWhatIsToBeExpected) {
  const std::string text = ExcitationTable(WithEvidence(MadeUpIdentification()));
  EXPECT_THAT(text, AllOf(HasSubstr("zigzag for 120 s would shrink YAW r|r| from +-40 % to +-13 %"),
                          HasSubstr("SURGE vr from unknown to +-0.12"),
                          HasSubstr("-> changing sides every 6 s")));
  // A manoeuvre that would do nothing is not advised.
  EXPECT_THAT(text, Not(HasSubstr("spins")));
}

TEST(EvidenceTable, SaysHowOftenBoundsHeld) {
  const std::string text = CertificateTable(WithEvidence(MadeUpIdentification()));
  EXPECT_THAT(text, AllOf(HasSubstr("0 of 98"), HasSubstr("34 of 98"), HasSubstr("93.8 % held"),
                          HasSubstr("98 of 100 simulated repeats"), HasSubstr("ellipsoid"),
                          HasSubstr("if the model is true")));
}

TEST(EvidenceTable, IsLeftOutWhereThereIsNone) {
  EXPECT_EQ(ExcitationTable(MadeUpIdentification()), "");
  EXPECT_EQ(CertificateTable(MadeUpIdentification()), "");
  EXPECT_THAT(ModelTable(MadeUpIdentification()), Not(HasSubstr("certificate")));
}

/// A log of the Yellowfish twin; bounds from residuals keep a repeat to milliseconds.
class CertifyCommand : public testing::Test {
 protected:
  CertifyCommand() {
    folder.Write("boat.textproto", PrintVehicle(YellowfishVehicle()));
    const auto track =
        Simulate(YellowfishTwin(), {}, SampleMission(1), kSampleMissionDurationS, 0.02);
    WriteTelemetryLog(folder.Path() / "log", Measure(track, YellowfishVehicle(), {}));
  }

  CommandOutcome Certified(const std::string& repeats) const {
    return Telltale({"identify", "--log", (folder.Path() / "log").string(), "--vehicle",
                     (folder.Path() / "boat.textproto").string(), "--bootstrap", "0", "--certify",
                     repeats, "--out", (folder.Path() / "model.json").string()});
  }

  TemporaryFolder folder;
};

TEST_F(CertifyCommand, PrintsAndWritesTheCertificate) {
  const CommandOutcome outcome = Certified("10");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("bounds held"), HasSubstr("of 10 simulated repeats"),
                                 HasSubstr("excitation"), HasSubstr("condition")));
  const auto model = ParseModelJson(TextOfFile(folder.Path() / "model.json"));
  ASSERT_TRUE(model) << model.error().Message();
  ASSERT_TRUE(model->certificate.has_value());
  EXPECT_EQ(model->certificate->asked, 10u);
  EXPECT_EQ(model->excitation.size(), 3u);
}

TEST_F(CertifyCommand, ANumberOutOfRangeIsAUsageErrorThatNamesTheRange) {
  for (const char* repeats : {"1", "1001", "-5", "many"}) {
    const CommandOutcome outcome = Certified(repeats);
    EXPECT_EQ(outcome.exit_code, 2) << repeats;
    EXPECT_THAT(outcome.err, testing::AnyOf(HasSubstr("[10, 1000]"), HasSubstr("--certify")));
  }
}

}  // namespace
}  // namespace telltale
