#include "telltale/core/diagnosis/residuals/wiring_check.hpp"

#include <functional>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat_with_effects.hpp"
#include "support/test_name.hpp"

namespace telltale {
namespace {

/// How commands reach the thrusters, and what is to be said of it.
struct WiringFault {
  const char* said;
  PropellerCommand (*wired)(const PropellerCommand&);
};

void PrintTo(const WiringFault& fault, std::ostream* out) {
  *out << fault.said;
}

class WrongWiring : public ::testing::TestWithParam<WiringFault> {};

// The recorded commands are those of a boat that is wired rightly, turned as the fault turns them.
TEST_P(WrongWiring, IsNamed) {
  PreparedDataset recording = testing::SimulateWithEffects({}, 120.0, 500);
  for (HeldCommands& commands : recording.commands) commands.ForEachCommand(GetParam().wired);
  const auto refusal = SuspectedWiringFault(recording, testing::StableBoat());
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->subject, "thrusters");
  EXPECT_EQ(refusal->reason, GetParam().said);
  EXPECT_THAT(refusal->advice, ::testing::HasSubstr("port and starboard channels"));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, WrongWiring,
    ::testing::Values(WiringFault{"port and starboard seem to be swapped",
                                  [](const PropellerCommand& d) {
                                    return PropellerCommand{d.starboard, d.port};
                                  }},
                      WiringFault{"the port thruster seems to be reversed",
                                  [](const PropellerCommand& d) {
                                    return PropellerCommand{-d.port, d.starboard};
                                  }},
                      WiringFault{"the starboard thruster seems to be reversed",
                                  [](const PropellerCommand& d) {
                                    return PropellerCommand{d.port, -d.starboard};
                                  }},
                      WiringFault{"both thrusters seem to be reversed",
                                  [](const PropellerCommand& d) {
                                    return PropellerCommand{-d.port, -d.starboard};
                                  }},
                      WiringFault{"port and starboard seem to be swapped, and both reversed",
                                  [](const PropellerCommand& d) {
                                    return PropellerCommand{-d.starboard, -d.port};
                                  }}),
    [](const auto& fault) { return AsTestName(fault.param.said); });

TEST(WiringCheck, FindsNothingInABoatThatIsWiredRightly) {
  EXPECT_EQ(
      SuspectedWiringFault(testing::SimulateWithEffects({}, 120.0, 500), testing::StableBoat()),
      std::nullopt);
}

// Large faults of other kinds are none of the wiring.
TEST(WiringCheck, LeavesOtherFaultsToTheDiagnosis) {
  for (const auto& [name, values] : {std::pair("thruster_imbalance", std::vector{0.5}),
                                     std::pair("heading_bias", std::vector{0.15})}) {
    EXPECT_EQ(
        SuspectedWiringFault(testing::SimulateWithEffects({{FindEffect(name), values}}, 120.0, 501),
                             testing::StableBoat()),
        std::nullopt)
        << name;
  }
}

}  // namespace
}  // namespace telltale
