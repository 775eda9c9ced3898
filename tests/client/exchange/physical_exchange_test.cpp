#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "support/made_up_identifications.hpp"
#include "telltale/client/exchange/mss.hpp"
#include "telltale/client/exchange/vrx.hpp"
#include "telltale/core/paper/sample_mission.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/proto/exchange.pb.h"

namespace telltale {
namespace {

using testing::HasSubstr;

constexpr double kSeparationM = 0.6;
constexpr double kMassKg = 20.0;

FossenVector KnownParameters() {
  FossenVector p;
  p << 1.5, 0.03, 0.18, 0.15, 0.45, 1.2, 0.05, -0.05, 0.25, 1.5, 0.4, -0.1, 0.05, 0.2, 0.3, 0.1,
      -0.1, 0.1, 0.5, 1.6, 0.4, 1.2, 0.7, 0.04, 0.06, 0.08, 0.25, 0.0, 0.1;
  return p;
}

Identification KnownPhysicalBoat() {
  Identification model = MadeUpPhysicalIdentification();
  const FossenVector p = KnownParameters();
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    model.physical->parameters[i].estimate = p[static_cast<Eigen::Index>(i)];
    model.physical->parameters[i].standard_error = 0.01;
  }
  model.dead_zone = {0.06, -0.08};
  model.thruster_time_constant->estimate = 0.25;
  return model;
}

Vehicle BoatOfTwentyKilograms() {
  Vehicle vehicle;
  vehicle.propeller_separation_m = kSeparationM;
  vehicle.mass_kg = kMassKg;
  return vehicle;
}

std::string SdfOf(const Identification& model) {
  const auto sdf = PrintVrx(model, BoatOfTwentyKilograms());
  EXPECT_TRUE(sdf);
  return sdf ? *sdf : "";
}

// Every number is a parameter times the mass, by hand: M and D are those of the boat itself, not
// divided by its mass matrix.
TEST(PhysicalVrx, HoldsMassAndDampingOfTheBoat) {
  const std::string sdf = SdfOf(KnownPhysicalBoat());
  for (const auto& [element, value] :
       std::vector<std::pair<std::string, std::string>>{{"xU", "3"},
                                                        {"xUU", "9"},
                                                        {"yV", "24"},
                                                        {"yVV", "30"},
                                                        {"nR", "5"},
                                                        {"nRR", "4"},
                                                        {"yDotV", "10"}}) {
    EXPECT_THAT(sdf, HasSubstr("  <" + element + ">" + value + "</" + element + ">  <!-- ± 0.2"));
  }
  EXPECT_THAT(sdf, HasSubstr("<mass>20</mass> and <izz>3.6</izz>"));
  EXPECT_THAT(sdf,
              HasSubstr("m23 0.6, Yr 1, Nv -1, Yrv 8, Nvv -2, Nvr 1, Yuv 6, Yur 2, Nuv -2, Nur 2"));
  // 20 kg (0.5 * 0.94 + 1.6 * 0.94^2) m/s^2, and in reverse 20 (0.4 * 0.92 + 1.2 * 0.92^2).
  EXPECT_THAT(sdf, HasSubstr("full forward command: 37.6752 N"));
  EXPECT_THAT(sdf, HasSubstr("full reverse command: -27.6736 N"));
}

TEST(PhysicalVrx, AddsNoNegativeMass) {
  Identification model = KnownPhysicalBoat();
  model.physical->parameters[0].estimate = 0.8;
  EXPECT_THAT(SdfOf(model),
              HasSubstr("<yDotV>0</yDotV>  <!-- the estimate, -4, is less than none"));
}

TEST(PhysicalVrx, NeedsAMass) {
  Vehicle vehicle = BoatOfTwentyKilograms();
  vehicle.mass_kg.reset();
  const auto refused = PrintVrx(KnownPhysicalBoat(), vehicle);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().advice, HasSubstr("mass_kg"));
}

/// The equations of the Python Vehicle Simulator for a boat of three degrees of freedom, from the
/// exported file alone: M nu_dot = tau - C(nu) nu - D(nu) nu with C by Fossen, Handbook of Marine
/// Craft Hydrodynamics and Motion Control, 2nd ed., (7.12); thrust with a first-order lag.
class ForeignBoat {
 public:
  explicit ForeignBoat(const proto::MssModel& file)
      : mass_(Matrix(file.physical().mass())),
        linear_(Matrix(file.physical().linear_damping())),
        lift_(Matrix(file.physical().lift_damping())),
        quadratic_(Matrix(file.physical().quadratic_damping())),
        cross_flow_(Matrix(file.physical().cross_flow_damping())),
        file_(file) {}

  /// x, y, psi, u, v, r, thrust ahead of port and of starboard, in reverse of both.
  using State = Eigen::Matrix<double, 10, 1>;

  State Step(const State& x, const PropellerCommand& delta, double h) const {
    const State a = Rate(x, delta);
    const State b = Rate(x + 0.5 * h * a, delta);
    const State c = Rate(x + 0.5 * h * b, delta);
    const State d = Rate(x + h * c, delta);
    return x + h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }

 private:
  static Eigen::Matrix3d Matrix(const google::protobuf::RepeatedField<double>& rows) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
  }

  double ThrustAhead(double command) const {
    const auto& curve = file_.physical().forward_thrust();
    const double e = std::max(command - file_.dead_zone().forward(), 0.0);
    return curve[0] * e + curve[1] * e * e;
  }

  double ThrustInReverse(double command) const {
    const auto& curve = file_.physical().reverse_thrust();
    const double e = std::max(file_.dead_zone().reverse() - command, 0.0);
    return -curve[0] * e - curve[1] * e * e;
  }

  State Rate(const State& x, const PropellerCommand& delta) const {
    const Eigen::Vector3d nu = x.segment<3>(3);
    Eigen::Matrix3d coriolis = Eigen::Matrix3d::Zero();
    coriolis(0, 2) = -(mass_(1, 1) * nu[1] + mass_(1, 2) * nu[2]);
    coriolis(1, 2) = mass_(0, 0) * nu[0];
    coriolis(2, 0) = -coriolis(0, 2);
    coriolis(2, 1) = -coriolis(1, 2);
    Eigen::Matrix3d damping = linear_ + nu[0] * lift_;
    damping += quadratic_ * nu.cwiseAbs().asDiagonal();
    damping += Eigen::Matrix3d((cross_flow_ * nu.cwiseAbs()).asDiagonal());
    const double half = 0.5 * file_.propeller_separation_m();
    const double speed = std::max(nu[0], 0.0) * file_.physical().reverse_loss_s_m();
    const double left = 1.0 / (1.0 + std::pow(speed, 8));
    const double imbalance = file_.physical().thrust_imbalance();
    const double port = (1.0 - imbalance) * (x[6] + left * x[8]);
    const double starboard = (1.0 + imbalance) * (x[7] + left * x[9]);
    const Eigen::Vector3d tau(port + starboard, 0.0, half * (port - starboard));
    const double lag_s = file_.thruster_time_constant_s().estimate();
    State rate;
    rate[0] = std::cos(x[2]) * nu[0] - std::sin(x[2]) * nu[1];
    rate[1] = std::sin(x[2]) * nu[0] + std::cos(x[2]) * nu[1];
    rate[2] = nu[2];
    rate.segment<3>(3) = mass_.inverse() * (tau - coriolis * nu - damping * nu);
    rate[6] = (ThrustAhead(delta.port) - x[6]) / lag_s;
    rate[7] = (ThrustAhead(delta.starboard) - x[7]) / lag_s;
    rate[8] = (ThrustInReverse(delta.port) - x[8]) / lag_s;
    rate[9] = (ThrustInReverse(delta.starboard) - x[9]) / lag_s;
    return rate;
  }

  Eigen::Matrix3d mass_;
  Eigen::Matrix3d linear_;
  Eigen::Matrix3d lift_;
  Eigen::Matrix3d quadratic_;
  Eigen::Matrix3d cross_flow_;
  const proto::MssModel& file_;
};

// Both step by 20 ms with errors of the fourth order or better: they part by far less than a
// millimetre in a minute, and by metres where a term, a sign or a place is wrong.
TEST(PhysicalMss, MovesAForeignSimulatorAlongTheSameTrack) {
  proto::MssModel file;
  ASSERT_FALSE(
      ParseJsonMessage(PrintMss(KnownPhysicalBoat(), BoatOfTwentyKilograms()), "mss", file));
  const ForeignBoat boat(file);
  constexpr double kStepS = 0.02;
  const auto track =
      Simulate(VesselModelOf(KnownParameters(), kSeparationM), {}, SampleMission(1), 60.0, kStepS);
  ForeignBoat::State x = ForeignBoat::State::Zero();
  double farthest_m = 0.0;
  for (std::size_t k = 0; k + 1 < track.size(); ++k) {
    x = boat.Step(x, track[k].delta, kStepS);
    farthest_m = std::max(farthest_m, std::hypot(x[0], x[1]));
  }
  const VesselState& end = track.back().state;
  EXPECT_GT(farthest_m, 5.0);
  EXPECT_NEAR(x[0], end.eta.x_m, 1e-3);
  EXPECT_NEAR(x[1], end.eta.y_m, 1e-3);
  EXPECT_NEAR(x[2], end.eta.psi_rad, 1e-3);
  EXPECT_NEAR(x[3], end.nu.u, 1e-3);
  EXPECT_NEAR(x[4], end.nu.v, 1e-3);
  EXPECT_NEAR(x[5], end.nu.r, 1e-3);
}

}  // namespace
}  // namespace telltale
