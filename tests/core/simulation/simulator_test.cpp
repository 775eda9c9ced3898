#include "telltale/core/simulation/simulator.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

// A boat of one's own choosing: thrust b_f (port + starboard), drag -k u|u|, damped sway and yaw.
VesselModel SimpleBoat(Discretisation discretisation, double sampling_period_s = 0.2) {
  VesselModel model;
  model.structure = Structure::kStaticQuadratic;
  model.parameterization = Parameterization::kPropeller;
  model.discretisation = discretisation;
  model.sampling_period_s = sampling_period_s;
  model.theta = {Eigen::VectorXd::Zero(9), Eigen::VectorXd::Zero(13), Eigen::VectorXd::Zero(13)};
  model.theta[0][0] = -0.4;  // u|u|, 1/m
  model.theta[0][6] = 0.35;  // f:d, m/s^2
  model.theta[1][6] = -1.0;  // v, 1/s
  model.theta[2][7] = -2.0;  // r, 1/s
  model.theta[2][10] = 0.8;  // f:d, 1/s^2
  return model;
}

Nu VelocityAfter(const VesselModel& model, const Nu& start, const PropellerCommand& delta,
                 double duration_s, int steps) {
  VesselState state{{}, start};
  for (int k = 0; k < steps; ++k) state = Advance(model, state, delta, duration_s / steps);
  return state.nu;
}

double Distance(const Nu& a, const Nu& b) {
  return Eigen::Vector3d(a.u - b.u, a.v - b.v, a.r - b.r).norm();
}

TEST(Advance, DiscreteModelTakesExactlyOneEulerStep) {
  const VesselModel model = YellowfishPaperModel();
  const Nu nu{0.9, -0.1, 0.3};
  for (const PropellerCommand& delta :
       {PropellerCommand{0.7, 0.4}, PropellerCommand{0.6, -0.2}, PropellerCommand{-0.3, 0.5}}) {
    const NuDot slope = model.Acceleration(nu, delta);
    const Nu next = Advance(model, {{}, nu}, delta, kYellowfishSamplingPeriodS).nu;
    EXPECT_EQ(next.u, nu.u + 0.2 * slope.u);
    EXPECT_EQ(next.v, nu.v + 0.2 * slope.v);
    EXPECT_EQ(next.r, nu.r + 0.2 * slope.r);
  }
}

TEST(Advance, ContinuousModelIsOfOrderFour) {
  const VesselModel twin = YellowfishTwin();
  // No velocity changes sign on the way: |v| and |r| have a kink there, which costs the order.
  const Nu start{0.5, -0.3, 0.4};
  const PropellerCommand delta{0.8, 0.3};
  const double duration_s = 1.6;
  const Nu exact = VelocityAfter(twin, start, delta, duration_s, 4096);
  const double coarse = Distance(VelocityAfter(twin, start, delta, duration_s, 4), exact);
  const double fine = Distance(VelocityAfter(twin, start, delta, duration_s, 8), exact);
  const double finer = Distance(VelocityAfter(twin, start, delta, duration_s, 16), exact);
  // 2^4 in the limit of small steps; these are not quite small.
  EXPECT_NEAR(coarse / fine, 16.0, 3.0);
  EXPECT_NEAR(fine / finer, 16.0, 1.5);
}

TEST(Advance, CoastingUnderQuadraticDragFollowsItsClosedForm) {
  // u_dot = -k u^2 has the solution u0 / (1 + k u0 t).
  const VesselModel boat = SimpleBoat(Discretisation::kContinuous);
  const Nu end = VelocityAfter(boat, {1.2, 0.0, 0.0}, {0.0, 0.0}, 5.0, 100);
  EXPECT_NEAR(end.u, 1.2 / (1.0 + 0.4 * 1.2 * 5.0), 1e-9);
}

TEST(Advance, AcceleratingBoatFollowsItsClosedForm) {
  // u_dot = T - k u^2 from rest has the solution u_inf tanh(t sqrt(T k)), u_inf = sqrt(T / k).
  const VesselModel boat = SimpleBoat(Discretisation::kContinuous);
  const double thrust = 0.35 * 2 * 0.5;
  const Nu end = VelocityAfter(boat, {}, {0.5, 0.5}, 3.0, 60);
  EXPECT_NEAR(end.u, std::sqrt(thrust / 0.4) * std::tanh(3.0 * std::sqrt(thrust * 0.4)), 1e-7);
}

TEST(Advance, SteadyTurnIsACircleOfRadiusSpeedOverYawRate) {
  const VesselModel boat = SimpleBoat(Discretisation::kContinuous);
  const PropellerCommand delta{0.6, 0.4};
  const double u = std::sqrt(0.35 * (0.6 + 0.4) / 0.4);
  const double r = 0.8 * (0.6 - 0.4) / 2.0;
  const double radius_m = u / r;
  const double turn_s = 2.0 * std::numbers::pi / r;
  const int steps = 4000;

  VesselState state{{0.0, 0.0, 0.0}, {u, 0.0, r}};
  double farthest_from_circle_m = 0.0;
  for (int k = 0; k < steps; ++k) {
    state = Advance(boat, state, delta, turn_s / steps);
    // Heading north and turning to starboard, the centre lies due east.
    const double from_centre_m = std::hypot(state.eta.x_m, state.eta.y_m - radius_m);
    farthest_from_circle_m = std::max(farthest_from_circle_m, std::abs(from_centre_m - radius_m));
  }
  EXPECT_NEAR(state.nu.u, u, 1e-12);
  EXPECT_NEAR(state.nu.r, r, 1e-12);
  EXPECT_NEAR(state.eta.psi_rad, 2.0 * std::numbers::pi, 1e-9);
  // A chord replaces each arc: off by R (r h)^2 / 24, 1.1e-6 m here.
  EXPECT_LT(farthest_from_circle_m, 5e-6);
  EXPECT_NEAR(std::hypot(state.eta.x_m, state.eta.y_m), 0.0, 1e-6);
}

TEST(Advance, PoseIgnoresNeitherSwayNorHeading) {
  VesselModel still = SimpleBoat(Discretisation::kContinuous);
  for (Eigen::VectorXd& theta : still.theta) theta.setZero();
  const double east = std::numbers::pi / 2;
  const VesselState end = Advance(still, {{1.0, 2.0, east}, {0.5, 0.25, 0.0}}, {}, 2.0);
  EXPECT_NEAR(end.eta.x_m, 1.0 - 0.5, 1e-15);
  EXPECT_NEAR(end.eta.y_m, 2.0 + 1.0, 1e-15);
}

TEST(Advance, RequiresADiscreteModelsOwnPeriodAndALag) {
  const VesselModel paper = YellowfishPaperModel();
  EXPECT_THROW(Advance(paper, {}, {}, 0.1), ContractViolation);
  EXPECT_THROW(Advance(YellowfishTwin(), {}, {}, 0.0), ContractViolation);
  VesselModel unset = YellowfishTwin();
  unset.discretisation = Discretisation::kUnknown;
  EXPECT_THROW(Advance(unset, {}, {}, 0.2), ContractViolation);
  VesselModel lagging = YellowfishTwin();
  lagging.structure = Structure::kFirstOrderDynamic;
  EXPECT_THROW(Advance(lagging, {}, {}, 0.2), ContractViolation);
}

TEST(Simulate, HoldsEachCommandUntilTheNext) {
  const VesselModel boat = SimpleBoat(Discretisation::kContinuous);
  const auto track =
      Simulate(boat, {}, {{10.0, {0.5, 0.5}}, {10.4, {-0.2, 0.1}}, {10.7, {}}}, 11.0, 0.1);
  ASSERT_EQ(track.size(), 11u);
  for (std::size_t k = 0; k < track.size(); ++k) {
    EXPECT_NEAR(track[k].time_s, 10.0 + 0.1 * static_cast<double>(k), 1e-12);
    const double expected_port = k < 4 ? 0.5 : k < 7 ? -0.2 : 0.0;
    EXPECT_EQ(track[k].delta.port, expected_port) << "at step " << k;
  }
}

TEST(Simulate, IsRepeatedAdvance) {
  const VesselModel paper = YellowfishPaperModel();
  const VesselState initial{{3.0, 4.0, 0.5}, {0.2, 0.0, 0.1}};
  const auto track = Simulate(paper, initial, {{0.0, {0.4, 0.6}}}, 2.0, 0.2);
  ASSERT_EQ(track.size(), 11u);
  EXPECT_EQ(track[0].state.nu.u, initial.nu.u);
  for (std::size_t k = 0; k + 1 < track.size(); ++k) {
    const VesselState next = Advance(paper, track[k].state, track[k].delta, 0.2);
    EXPECT_EQ(track[k + 1].state.nu.r, next.nu.r);
    EXPECT_EQ(track[k + 1].state.eta.x_m, next.eta.x_m);
  }
}

TEST(Simulate, RequiresCommandsInOrderOfTime) {
  const VesselModel twin = YellowfishTwin();
  EXPECT_THROW(Simulate(twin, {}, {}, 1.0, 0.1), ContractViolation);
  EXPECT_THROW(Simulate(twin, {}, {{1.0, {}}, {0.5, {}}}, 2.0, 0.1), ContractViolation);
  EXPECT_THROW(Simulate(twin, {}, {{1.0, {}}}, 0.5, 0.1), ContractViolation);
}

}  // namespace
}  // namespace telltale
