#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/proto/gain.pb.h"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class GainTest : public testing::Test {
 protected:
  CommandOutcome Gain(const Identification& model, std::vector<std::string> more) const {
    const std::string file = folder.Write("model.json", PrintModelJson(model)).string();
    std::vector<std::string> arguments = {"gain", "--model", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }

  static proto::InputGains Read(const std::string& text) {
    proto::InputGains gains;
    const auto fault = ParseJsonMessage(text, "gain", gains);
    EXPECT_FALSE(fault) << fault->Message();
    return gains;
  }

  TemporaryFolder folder;
};

// Port 0.5: 2 0.25 + 3 0.5 = 2. Starboard -0.2: -4 0.04 - 5 0.2 = -1.16. Sum 0.84, difference 3.16.
// Regressors 0.25, 0.5, 0.04, 0.2 of unit variance each: error sqrt(0.3541). 95 % of a normal law
// lie within 1.959964 deviations.
TEST_F(GainTest, IsTheHandWorkedGainInBothUnits) {
  const CommandOutcome outcome = Gain(IdentificationByHand(), {"--delta", "0.5,-0.2", "--json"});
  ASSERT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  const proto::InputGains gains = Read(outcome.out);
  ASSERT_EQ(gains.gains_size(), 1);
  const proto::CommandGain& gain = gains.gains(0);
  EXPECT_EQ(gain.region(), "FR");
  EXPECT_NEAR(gain.surge().continuous().estimate(), 0.84, 1e-14);
  EXPECT_NEAR(gain.sway().continuous().estimate(), 1.58, 1e-14);
  EXPECT_NEAR(gain.yaw().continuous().estimate(), 6.32, 1e-14);
  const double error = std::sqrt(0.3541);
  EXPECT_NEAR(gain.surge().continuous().standard_error(), error, 1e-14);
  EXPECT_NEAR(gain.surge().continuous().interval().upper(), 0.84 + 1.959964 * error, 1e-6);
  EXPECT_EQ(gain.surge().continuous().interval().level(), 0.95);
  EXPECT_NEAR(gain.yaw().discrete().estimate(), 0.2 * 6.32, 1e-14);
  EXPECT_NEAR(gain.yaw().discrete().interval().lower(), 0.2 * (6.32 - 1.959964 * error), 1e-6);
  EXPECT_FALSE(gains.has_settling_time_s());
}

// Half of each estimate, about which the bounds are as wide as before.
TEST_F(GainTest, TakesTheValuesForSimulation) {
  Identification model = IdentificationByHand();
  for (const Coefficient& c : model.coefficients) model.simulation.push_back(0.5 * c.estimate);
  const proto::InputGains gains = Read(Gain(model, {"--delta", "0.5,-0.2", "--json"}).out);
  EXPECT_NEAR(gains.gains(0).surge().continuous().estimate(), 0.42, 1e-14);
  EXPECT_NEAR(gains.gains(0).surge().continuous().standard_error(), std::sqrt(0.3541), 1e-14);
}

TEST_F(GainTest, PrintsACatalogueInAllRegionsButAstern) {
  const CommandOutcome outcome = Gain(IdentificationByHand(), {});
  ASSERT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("port 1, starboard 1 (FF)"),
                                 HasSubstr("port 0.5, starboard -0.5 (FR)"), HasSubstr("(RF)"),
                                 HasSubstr("m/s^2"), HasSubstr("rad/s^2"), HasSubstr("95 % bounds"),
                                 HasSubstr("follows its command at once")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("paper's surge")));
}

// tau = 0.25 s: 1 % is left after 0.25 ln 100 = 1.151293 s; bounds 0.23 and 0.27 alike.
TEST_F(GainTest, ShowsWhenAnInitialConditionHasSettled) {
  const Identification model = MadeUpDynamicIdentification();
  EXPECT_THAT(Gain(model, {}).out, HasSubstr("left after 1.151 s, 95 % bounds [1.059, 1.243]"));
  const proto::Bounded settling =
      Read(Gain(model, {"--out", (folder.Path() / "gain.json").string(), "--json"}).out)
          .settling_time_s();
  EXPECT_NEAR(settling.estimate(), 1.1512925464970229, 1e-14);
  EXPECT_NEAR(settling.standard_error(), 0.0125 * 4.605170185988092, 1e-14);
  EXPECT_NEAR(Read(TextOfFile(folder.Path() / "gain.json")).settling_time_s().estimate(),
              settling.estimate(), 0.0);
}

TEST_F(GainTest, NamesWhatAModelDoesNotDetermine) {
  Identification partial = IdentificationByHand();
  std::erase_if(partial.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  const auto n = static_cast<Eigen::Index>(partial.coefficients.size());
  partial.covariance = Eigen::MatrixXd::Identity(n, n);
  EXPECT_THAT(Gain(partial, {}).out, HasSubstr("refused"));
  EXPECT_FALSE(Read(Gain(partial, {"--json"}).out).gains(0).has_sway());

  EXPECT_THAT(Gain(MadeUpIdentification(Parameterization::kPaper), {}).out,
              HasSubstr("forward thrust curve alone"));
}

TEST_F(GainTest, ChecksItsInputs) {
  const Identification model = IdentificationByHand();
  for (const char* wrong : {"0.5", "0.5,wide", "1.01,0", "0,-1.5", "nan,0", "0.1,0.2,0.3"}) {
    const CommandOutcome outcome = Gain(model, {"--delta", wrong});
    EXPECT_EQ(outcome.exit_code, kExitUsage) << wrong;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("--delta"), HasSubstr(wrong)));
  }
  const CommandOutcome astern = Gain(model, {"--delta", "-0.5,-0.5", "--delta", "-1,1"});
  EXPECT_EQ(astern.exit_code, kExitSuccess) << astern.err;
  EXPECT_THAT(astern.out, AllOf(HasSubstr("(RR)"), HasSubstr("(RF)")));
  EXPECT_EQ(Telltale({"gain"}).exit_code, kExitUsage);
  EXPECT_EQ(Gain(model, {"--out", "/nowhere/gain.json"}).exit_code, kExitFailure);
}

}  // namespace
}  // namespace telltale
