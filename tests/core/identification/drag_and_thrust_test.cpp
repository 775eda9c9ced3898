#include "telltale/core/identification/drag_and_thrust.hpp"

#include <gtest/gtest.h>

#include "support/physical_boat.hpp"

namespace telltale {
namespace {

using enum FossenParameter;
using testing::kPhysicalBoatSeparation;
using testing::PhysicalBoat;

double WidthOf(const ForceAtPoint& force) {
  return (force.interval.upper - force.interval.lower) / force.estimate;
}

class DragAndThrust : public ::testing::Test {
 protected:
  const PhysicalModel known_ = *testing::KnownPhysicalBoat(PhysicalBoat(), 0.05).physical;
  const std::vector<ForceAtPoint> forces_ = DragAndThrustOf(known_);
  const FossenVector p_ = PhysicalBoat();
};

TEST_F(DragAndThrust, IsTheThrustCurveAtHalfAndFullCommand) {
  const auto forward = [&](double e) { return 0.5 * e + 1.6 * e * e; };  // Tf1, Tf2
  const auto reverse = [&](double e) { return 0.4 * e + 1.2 * e * e; };  // Tr1, Tr2
  EXPECT_NEAR(forces_[5].estimate, forward(0.5 - 0.06), 1e-12);          // less the dead band
  EXPECT_NEAR(forces_[6].estimate, forward(1.0 - 0.06), 1e-12);
  EXPECT_NEAR(forces_[7].estimate, reverse(0.5 - 0.08), 1e-12);
  EXPECT_NEAR(forces_[8].estimate, reverse(1.0 - 0.08), 1e-12);
}

// A simulation of the boat without its lateral terms keeps the speed: nothing accelerates it.
TEST_F(DragAndThrust, BalancesAtTheTopSpeed) {
  FossenVector even = p_;
  even[At(kImbalance)] = 0.0;
  const VesselModel boat = VesselModelOf(even, kPhysicalBoatSeparation);
  const NuDot top = boat.Acceleration({forces_[0].estimate, 0.0, 0.0}, {1.0, 1.0});
  EXPECT_NEAR(top.u, 0.0, 1e-12);
  EXPECT_NEAR(forces_[2].at, 0.5 * forces_[0].estimate, 1e-12);
  const NuDot coasting = boat.Acceleration({forces_[2].at, 0.0, 0.0}, {0.0, 0.0});
  EXPECT_NEAR(coasting.u, -forces_[2].estimate, 1e-12);
}

TEST_F(DragAndThrust, BalancesInATurnOnTheSpot) {
  FossenVector even = p_;
  even[At(kImbalance)] = 0.0;
  even[At(kM23)] = even[At(kYr)] = 0.0;  // or it would drift sideways
  const VesselModel boat = VesselModelOf(even, kPhysicalBoatSeparation);
  const NuDot turning = boat.Acceleration({0.0, 0.0, forces_[1].estimate}, {1.0, -1.0});
  EXPECT_NEAR(turning.r, 0.0, 1e-12);
}

// What a linear and a quadratic term trade against each other leaves their sum.
TEST_F(DragAndThrust, IsKnownBetterThanTermsThatTradeAgainstEachOther) {
  PhysicalModel traded = known_;
  const Eigen::Index linear = At(kForwardLinear);
  const Eigen::Index quadratic = At(kForwardQuadratic);
  const double e = 1.0 - p_[At(kForwardDeadBand)];
  traded.covariance.setZero();
  traded.covariance.diagonal().setConstant(1e-12);
  traded.covariance(linear, linear) += 0.01;
  traded.covariance(quadratic, quadratic) += 0.01 / (e * e);
  traded.covariance(linear, quadratic) = traded.covariance(quadratic, linear) = -0.01 / e;
  const std::vector<ForceAtPoint> forces = DragAndThrustOf(traded);
  EXPECT_LT(WidthOf(forces[6]), 0.01 * WidthOf(forces[5]));
}

TEST_F(DragAndThrust, HoldsTheEstimateAndTakesOtherParametersToTheSamePoints) {
  for (const ForceAtPoint& force : forces_) {
    EXPECT_LT(force.interval.lower, force.estimate) << force.name;
    EXPECT_GT(force.interval.upper, force.estimate) << force.name;
  }
  const Eigen::VectorXd same = ForcesAt(forces_, p_, kPhysicalBoatSeparation);
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    EXPECT_EQ(same[static_cast<Eigen::Index>(i)], forces_[i].estimate) << forces_[i].name;
  }
}

// As a model stands in a file that knows it exactly.
TEST_F(DragAndThrust, IsExactOfAModelWithoutErrors) {
  PhysicalModel exact = known_;
  exact.covariance.setZero();
  for (const ForceAtPoint& force : DragAndThrustOf(exact)) {
    EXPECT_NEAR(force.interval.lower, force.estimate, 1e-6) << force.name;
    EXPECT_NEAR(force.interval.upper, force.estimate, 1e-6) << force.name;
  }
}

// A boat without any drag has no top speed; its other points stay finite.
TEST_F(DragAndThrust, StaysFiniteWithoutDrag) {
  FossenVector without = p_;
  without[At(kXu)] = without[At(kXuu)] = without[At(kNr)] = without[At(kNrr)] = 0.0;
  const PhysicalModel model = *testing::KnownPhysicalBoat(without, 0.05).physical;
  for (const ForceAtPoint& force : DragAndThrustOf(model)) {
    EXPECT_TRUE(std::isfinite(force.estimate)) << force.name;
  }
}

}  // namespace
}  // namespace telltale
