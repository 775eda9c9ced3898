#include "telltale/core/vessel/fossen_model.hpp"

#include <gtest/gtest.h>

#include "support/physical_boat.hpp"
#include "telltale/core/vessel/body_dynamics.hpp"

namespace telltale {
namespace {

using testing::PhysicalBoat;

constexpr double kSeparation = 0.6;

// The regressors of one propeller in the order of FossenDynamics.
FossenDynamics::Thrusts Steady(double e) {
  return e >= 0.0 ? FossenDynamics::Thrusts(e, e * e, 0.0, 0.0)
                  : FossenDynamics::Thrusts(0.0, 0.0, e, e * e);
}

TEST(FossenModel, CoriolisForcesDoNoWork) {
  FossenVector p = PhysicalBoat();
  for (const auto drag :
       {FossenParameter::kXu, FossenParameter::kXuu, FossenParameter::kYv, FossenParameter::kYr,
        FossenParameter::kNv, FossenParameter::kNr, FossenParameter::kYvv, FossenParameter::kYrv,
        FossenParameter::kNvv, FossenParameter::kNvr, FossenParameter::kNrr, FossenParameter::kYuv,
        FossenParameter::kYur, FossenParameter::kNuv, FossenParameter::kNur}) {
    p[At(drag)] = 0.0;
  }
  Eigen::Matrix3d mass = Eigen::Matrix3d::Identity();
  mass(1, 1) = p[At(FossenParameter::kM22)];
  mass(1, 2) = mass(2, 1) = p[At(FossenParameter::kM23)];
  mass(2, 2) = p[At(FossenParameter::kM33)];
  const FossenDynamics dynamics(p, kSeparation);
  for (const Eigen::Vector3d& nu :
       {Eigen::Vector3d(1.3, -0.2, 0.4), Eigen::Vector3d(-0.5, 0.3, -1.1)}) {
    const auto at = dynamics.At(nu, Steady(0.0), Steady(0.0));
    EXPECT_NEAR(nu.dot(mass * at.nu_dot), 0.0, 1e-12);  // d/dt of nu' M nu / 2
  }
}

TEST(FossenModel, LiesInTheRegressorsOfTheStructures) {
  const FossenVector p = PhysicalBoat();
  const FossenDynamics dynamics(p, kSeparation);
  const VesselModel model = VesselModelOf(p, kSeparation);
  for (const PropellerCommand command :
       {PropellerCommand{0.8, 0.3}, PropellerCommand{0.5, -0.7}, PropellerCommand{-0.9, -0.2}}) {
    const auto beyond = [&](double d) { return model.dead_zone.Apply(d); };
    const Eigen::Vector3d nu(1.2, -0.3, 0.5);
    const auto physical =
        dynamics.At(nu, Steady(beyond(command.port)), Steady(beyond(command.starboard)));
    const NuDot free = model.Acceleration({nu[0], nu[1], nu[2]}, command);
    EXPECT_NEAR(physical.nu_dot[0], free.u, 1e-12);
    EXPECT_NEAR(physical.nu_dot[1], free.v, 1e-12);
    EXPECT_NEAR(physical.nu_dot[2], free.r, 1e-12);
  }
}

TEST(FossenModel, AMassThatIsNotPositiveDefiniteIsNoBoat) {
  FossenVector p = PhysicalBoat();
  p[At(FossenParameter::kM23)] = 1.0;
  EXPECT_ANY_THROW(FossenDynamics(p, kSeparation));
}

}  // namespace
}  // namespace telltale
