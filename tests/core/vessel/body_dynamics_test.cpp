#include "vessel/body_dynamics.hpp"

#include <gtest/gtest.h>

#include "simulation/simulator.hpp"
#include "simulation/yellowfish.hpp"
#include "support/boats.hpp"

namespace telltale {
namespace {

void ExpectSameAccelerations(const VesselModel& model) {
  const BodyDynamics dynamics(model);
  for (const Nu& nu : {Nu{1.2, -0.3, 0.4}, Nu{-0.5, 0.2, -0.8}, Nu{}}) {
    for (const PropellerCommand& delta :
         {PropellerCommand{0.8, 0.3}, PropellerCommand{-0.5, 0.6}}) {
      const ThrustRegressors thrust = model.SteadyThrust(delta);
      const NuDot general = model.AccelerationUnder(thrust, nu);
      const NuDot fast = dynamics.Under(dynamics.Propelled(thrust), nu);
      EXPECT_NEAR(fast.u, general.u, 1e-14);
      EXPECT_NEAR(fast.v, general.v, 1e-14);
      EXPECT_NEAR(fast.r, general.r, 1e-14);
    }
  }
}

TEST(BodyDynamics, GivesTheModelsAccelerations) {
  ExpectSameAccelerations(testing::StableBoat());
  ExpectSameAccelerations(YellowfishPaperModel());
}

TEST(BodyDynamics, StepsAsTheSimulatorDoes) {
  const VesselModel model = testing::StableBoat();
  const PropellerCommand delta{0.7, -0.2};
  VesselState state;
  state.nu = {0.9, 0.1, -0.3};
  const Nu general = Advance(model, state, delta, 0.1).nu;
  const BodyDynamics dynamics(model);
  const Nu fast = dynamics.Step(dynamics.Propelled(model.SteadyThrust(delta)), state.nu, 0.1);
  EXPECT_NEAR(fast.u, general.u, 1e-14);
  EXPECT_NEAR(fast.v, general.v, 1e-14);
  EXPECT_NEAR(fast.r, general.r, 1e-14);
}

}  // namespace
}  // namespace telltale
