#include "telltale/core/paper/yellowfish.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "telltale/core/simulation/manoeuvres.hpp"

namespace telltale {
namespace {

// The paper's printed equations, written out term by term as they stand there: what X_u, X_v and
// X_r multiply, and the input gain by region. Source: Proposition 1, Appendix A and the input-gain
// equation of "Practical identification approach for the actuation dynamics of autonomous surface
// vehicles".
struct Increment {
  double u, v, r;
};

double TurningIncrement(const std::array<double, 13>& x, const Nu& nu,
                        const PropellerCommand& delta) {
  const auto [u, v, r] = nu;
  const double mean = (delta.port + delta.starboard) / 2;
  const double diff = delta.port - delta.starboard;
  const bool port_forward = delta.port >= 0;
  const bool starboard_forward = delta.starboard >= 0;
  double gain = x[10] * mean * diff + x[12] * diff / 2;
  const double mixed = x[9] * (mean * mean + diff * diff / 4) + x[11] * mean;
  if (port_forward && !starboard_forward) gain += mixed;
  if (!port_forward && starboard_forward) gain -= mixed;
  return x[0] * v * std::abs(v) + x[1] * v * std::abs(r) + x[2] * r * std::abs(v) +
         x[3] * r * std::abs(r) + x[4] * u * v + x[5] * u * r + x[6] * v + x[7] * r + x[8] + gain;
}

Increment PrintedIncrement(const Nu& nu, const PropellerCommand& delta) {
  const double mean = (delta.port + delta.starboard) / 2;
  const double diff = delta.port - delta.starboard;
  const double surge = -0.0616 * nu.u * std::abs(nu.u) + 0.0272 * nu.v * nu.r -
                       0.0098 * nu.r * nu.r + 0.0072 * nu.u - 0.0001 -
                       0.0145 * (mean * mean + diff * diff / 4) + 0.1403 * mean;
  constexpr std::array<double, 13> kSway = {-0.0214, -0.0714, -0.0334, -0.0123, -0.0400,
                                            0.0329,  0.0407,  0.0334,  -0.0018, 0.0092,
                                            -0.0381, -0.0032, -0.0505};
  constexpr std::array<double, 13> kYaw = {0.0424,  -0.1168, 0.0369,  -0.0077, -0.0310,
                                           -0.0931, 0.0882,  -0.1505, 0.0055,  -0.0872,
                                           -0.0743, 0.0814,  0.3206};
  return {surge, TurningIncrement(kSway, nu, delta), TurningIncrement(kYaw, nu, delta)};
}

// A few roundings apart: the table is divided by 0.2 and multiplied by it again.
constexpr double kRounding = 1e-15;

TEST(YellowfishPaperModel, IsThePrintedTable) {
  const VesselModel model = YellowfishPaperModel();
  const Nu states[] = {{0, 0, 0}, {1.1, 0.2, -0.3}, {0.4, -0.3, 0.5}, {-0.2, 0.1, 0.6}};
  const PropellerCommand commands[] = {{0.8, 0.3}, {0.2, 0.9}, {0.7, -0.4}, {-0.5, 0.6}};
  for (const Nu& nu : states) {
    for (const PropellerCommand& delta : commands) {
      const Nu next = Advance(model, {{}, nu}, delta, kYellowfishSamplingPeriodS).nu;
      const Increment printed = PrintedIncrement(nu, delta);
      EXPECT_NEAR(next.v, nu.v + printed.v, kRounding);
      EXPECT_NEAR(next.r, nu.r + printed.r, kRounding);
      if (RegionOf(delta) != PropellerRegion::kFF) continue;
      EXPECT_NEAR(next.u, nu.u + printed.u, kRounding);
    }
  }
}

TEST(YellowfishTwin, AgreesWithTheTableWhereTheTableHasOneMeaning) {
  // Surge in FF; sway and yaw in FR and RF, whose meaning of the table the twin takes over.
  const VesselModel twin = YellowfishTwin();
  const VesselModel paper = YellowfishPaperModel();
  const Nu nu{0.7, -0.2, 0.4};
  for (const PropellerCommand& delta : {PropellerCommand{0.9, 0.1}, PropellerCommand{0.3, 0.3}}) {
    EXPECT_NEAR(twin.Acceleration(nu, delta).u, paper.Acceleration(nu, delta).u, kRounding);
  }
  for (const PropellerCommand& delta :
       {PropellerCommand{0.8, -0.5}, PropellerCommand{0.1, -0.9}, PropellerCommand{-0.4, 0.6}}) {
    EXPECT_NEAR(twin.Acceleration(nu, delta).v, paper.Acceleration(nu, delta).v, kRounding);
    EXPECT_NEAR(twin.Acceleration(nu, delta).r, paper.Acceleration(nu, delta).r, kRounding);
  }
}

TEST(YellowfishTwin, HasThePapersSurgeThrust) {
  const Eigen::VectorXd surge = YellowfishTwin().theta[0];
  EXPECT_DOUBLE_EQ(surge[5], -0.0145 / 2 / 0.2);
  EXPECT_DOUBLE_EQ(surge[6], 0.1403 / 2 / 0.2);
}

TEST(YellowfishTwin, PropellersPushTheWayTheyTurn) {
  const VesselModel twin = YellowfishTwin();
  const NuDot idle = twin.Acceleration({}, {});
  double last_u = twin.Acceleration({}, {-1.01, -1.01}).u;
  for (double delta = -1.0; delta <= 1.0; delta += 0.01) {
    const NuDot both = twin.Acceleration({}, {delta, delta});
    EXPECT_GT(both.u, last_u) << "surge thrust must grow with the command, at " << delta;
    EXPECT_NEAR(both.v, idle.v, kRounding) << "equal commands must not push sideways";
    EXPECT_NEAR(both.r, idle.r, kRounding) << "equal commands must not turn";
    last_u = both.u;
    if (std::abs(delta) < 1e-9) continue;
    const double sign = delta > 0 ? 1.0 : -1.0;
    EXPECT_GT(sign * (both.u - idle.u), 0.0) << delta;
    EXPECT_GT(sign * (twin.Acceleration({}, {delta, 0.0}).r - idle.r), 0.0) << delta;
    EXPECT_LT(sign * (twin.Acceleration({}, {0.0, delta}).r - idle.r), 0.0) << delta;
  }
}

TEST(YellowfishTwin, ReverseIsWeakerThanForward) {
  const VesselModel twin = YellowfishTwin();
  const double idle = twin.Acceleration({}, {}).u;
  for (double delta = 0.1; delta <= 1.0; delta += 0.1) {
    const double forward = twin.Acceleration({}, {delta, delta}).u - idle;
    const double reverse = twin.Acceleration({}, {-delta, -delta}).u - idle;
    // The yaw table's b_r / b_f = (0.3206 - 0.0814) / (0.3206 + 0.0814).
    EXPECT_NEAR(-reverse / forward, 0.2392 / 0.4020, 1e-12);
  }
}

TEST(YellowfishTwin, ReachesTheSpeedWhereDragBalancesThrust) {
  // Straight ahead at full command: -0.308 u^2 + 0.036 u - 0.0005 + 2 (0.35075 - 0.03625) = 0 at
  // u = 1.4886 m/s; the sway and yaw that creep in take less than a centimetre per second of it.
  const auto track = Simulate(YellowfishTwin(), {}, {{0.0, {1.0, 1.0}}}, 60.0, 0.05);
  EXPECT_NEAR(track.back().state.nu.u, 1.4886, 0.01);
}

}  // namespace
}  // namespace telltale
