#include "telltale/core/vessel/body_dynamics.hpp"

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/simulator.hpp"

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

class AtVelocity : public ::testing::TestWithParam<std::array<double, 3>> {
 protected:
  Nu nu_{GetParam()[0], GetParam()[1], GetParam()[2]};
};

/// Quadratics: central differences are exact but for rounding as long as no sign changes.
TEST_P(AtVelocity, SlopeIsThatOfTheAcceleration) {
  constexpr double kApart = 1e-4;
  const BodyDynamics dynamics(YellowfishTwin());
  const Eigen::Matrix3d slope = dynamics.ByVelocity(nu_);
  const std::array<double Nu::*, 3> axes = {&Nu::u, &Nu::v, &Nu::r};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    Nu above = nu_;
    Nu below = nu_;
    above.*axes[i] += kApart;
    below.*axes[i] -= kApart;
    const NuDot high = dynamics.Under({}, above);
    const NuDot low = dynamics.Under({}, below);
    const auto column = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(slope(0, column), (high.u - low.u) / (2.0 * kApart), 1e-9);
    EXPECT_NEAR(slope(1, column), (high.v - low.v) / (2.0 * kApart), 1e-9);
    EXPECT_NEAR(slope(2, column), (high.r - low.r) / (2.0 * kApart), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Quadrants, AtVelocity,
                         ::testing::Values(std::array{1.2, 0.3, 0.4}, std::array{0.8, -0.2, 0.5},
                                           std::array{0.8, 0.2, -0.5},
                                           std::array{-0.4, -0.1, -0.2}));

}  // namespace
}  // namespace telltale
