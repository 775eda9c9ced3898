#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class CompareTest : public testing::Test {
 protected:
  CompareTest() {
    earlier.provenance = {};
    later = earlier;
    later.window.start_s = earlier.window.end_s + 100.0;
    later.window.end_s = later.window.start_s + 600.0;
  }

  CommandOutcome Compare(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "compare", "--model", folder.Write("a.json", PrintModelJson(earlier)).string(), "--model",
        folder.Write("b.json", PrintModelJson(later)).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Telltale(arguments);
  }

  TemporaryFolder folder;
  Identification earlier = IdentificationByHand();
  Identification later;
};

TEST_F(CompareTest, FindsNoDifferenceWhereThereIsNone) {
  const CommandOutcome outcome = Compare();
  EXPECT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("The models do not differ significantly, p = 1.\n"));
  EXPECT_THAT(outcome.out, HasSubstr("no different from the other model: p = 1"));
  EXPECT_THAT(outcome.err, IsEmpty());
}

// Ten standard errors of the difference in one coefficient: chi-square 100 over 32.
TEST_F(CompareTest, NamesTheCoefficientThatDiffers) {
  later.coefficients[6].estimate += 10.0 * std::sqrt(2.0);
  const CommandOutcome outcome = Compare({"--json"});
  ASSERT_EQ(outcome.exit_code, kExitSuccess) << outcome.err;
  proto::ModelChange change;
  ASSERT_FALSE(ParseJsonMessage(outcome.out, "change", change));
  EXPECT_EQ(change.verdict(), proto::DIFFERS);
  EXPECT_NEAR(change.statistic(), 100.0, 1e-9);
  EXPECT_EQ(change.degrees_of_freedom(), 32u);
  ASSERT_EQ(change.coefficients_size(), 32);
  EXPECT_EQ(change.coefficients(0).regressor(), "f:d");
  EXPECT_THAT(Compare().out, AllOf(StartsWith("The models differ, p = "),
                                   HasSubstr("differs from the other model"),
                                   HasSubstr("SURGE f:d by +10.0 sigma")));
}

TEST_F(CompareTest, ShowsWhatEachModelSimulatesWith) {
  EXPECT_THAT(Compare().out, Not(HasSubstr("Values for simulation")));
  for (const Coefficient& c : later.coefficients) later.simulation.push_back(0.5 * c.estimate);
  const CommandOutcome outcome = Compare();
  EXPECT_THAT(outcome.out, StartsWith("The models do not differ significantly"));
  // Forward thrust, linear, in surge: 3 and half of it.
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Values for simulation"),
                                 ContainsRegex("SURGE f:d +3.000 +1.500 +-1.500")));
}

TEST_F(CompareTest, RefusesModelsMadeWithOtherOptions) {
  later.sampling_period_s = 0.5;
  const CommandOutcome outcome = Compare();
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_THAT(outcome.err, HasSubstr("the models differ in sampling period"));
}

TEST_F(CompareTest, WarnsOfWindowsThatOverlap) {
  later.window = earlier.window;
  const CommandOutcome outcome = Compare();
  EXPECT_EQ(outcome.exit_code, kExitSuccess);
  EXPECT_THAT(outcome.err, HasSubstr("overlap"));
}

TEST_F(CompareTest, WantsTwoModels) {
  const std::string file = folder.Write("a.json", PrintModelJson(earlier)).string();
  EXPECT_EQ(Telltale({"compare", "--model", file}).exit_code, kExitUsage);
  EXPECT_EQ(Telltale({"compare"}).exit_code, kExitUsage);
}

}  // namespace
}  // namespace telltale
