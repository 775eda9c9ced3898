#include <cmath>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "telltale/client/exchange/mss.hpp"
#include "telltale/client/exchange/posterior_draws.hpp"
#include "telltale/client/exchange/vrx.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/proto/exchange.pb.h"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A boat with known physics: m11 = m22 = 15 kg, yaw inertia 3 kg m^2, d = 0.6 m, X_u = -6 N s/m,
/// X_|u|u = -9, Y_v = -30, Y_|v|v = -45, N_r = -1.5, N_|r|r = -0.6, thrust 20 d^2 + 10 d forward,
/// -8 d^2 + 7 d in reverse.
Identification KnownBoat() {
  Identification model = MadeUpIdentification();
  model.dead_zone = {};
  const auto n = static_cast<Eigen::Index>(model.coefficients.size());
  model.covariance = 1e-4 * Eigen::MatrixXd::Identity(n, n);
  for (Coefficient& c : model.coefficients) {
    c.status = CoefficientStatus::kEstimated;
    c.standard_error = 0.01;
    c.estimate = 0.0;
    const auto is = [&](Equation equation, const char* regressor) {
      return c.equation == equation && c.regressor == regressor;
    };
    if (is(Equation::kSurge, "u")) c.estimate = -6.0 / 15.0;
    if (is(Equation::kSurge, "u|u|")) c.estimate = -9.0 / 15.0;
    if (is(Equation::kSway, "v")) c.estimate = -30.0 / 15.0;
    if (is(Equation::kSway, "v|v|")) c.estimate = -45.0 / 15.0;
    if (is(Equation::kYaw, "r")) c.estimate = -1.5 / 3.0;
    if (is(Equation::kYaw, "r|r|")) c.estimate = -0.6 / 3.0;
    const double divisor = c.equation == Equation::kSurge ? 15.0 : 3.0 / 0.3;
    if (c.equation == Equation::kSway) continue;
    if (c.regressor == "f:d^2") c.estimate = 20.0 / divisor;
    if (c.regressor == "f:d") c.estimate = 10.0 / divisor;
    if (c.regressor == "r:d^2") c.estimate = -8.0 / divisor;
    if (c.regressor == "r:d") c.estimate = 7.0 / divisor;
  }
  return model;
}

Vehicle VehicleWithMass() {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.propeller_separation_m = 0.6;
  vehicle.mass_kg = 15.0;
  return vehicle;
}

double ElementOf(const std::string& xml, const std::string& name) {
  const auto begin = xml.find("  <" + name + '>');
  EXPECT_NE(begin, std::string::npos) << name;
  return begin == std::string::npos ? NAN : std::stod(xml.substr(begin + name.size() + 4));
}

// ---- vrx ---------------------------------------------------------------------------------------

TEST(Vrx, GivesTheKnownBoatsPhysicsBack) {
  const auto xml = PrintVrx(KnownBoat(), VehicleWithMass());
  ASSERT_TRUE(xml) << xml.error().reason;
  EXPECT_NEAR(ElementOf(*xml, "xU"), 6.0, 1e-5);
  EXPECT_NEAR(ElementOf(*xml, "xUU"), 9.0, 1e-5);
  EXPECT_NEAR(ElementOf(*xml, "yV"), 30.0, 1e-4);
  EXPECT_NEAR(ElementOf(*xml, "yVV"), 45.0, 1e-4);
  EXPECT_NEAR(ElementOf(*xml, "nR"), 1.5, 1e-5);
  EXPECT_NEAR(ElementOf(*xml, "nRR"), 0.6, 1e-5);
  EXPECT_THAT(*xml, AllOf(HasSubstr("<mass>15</mass>"), HasSubstr("<izz>3</izz>"),
                          HasSubstr("full forward command: 30 N"),
                          HasSubstr("full reverse command: -15 N"), HasSubstr("ASSUMED")));
}

TEST(Vrx, NeverDrivesTheBoatWithADrag) {
  Identification model = KnownBoat();
  model.coefficients[0].estimate = 0.2;                           // u|u|
  model.coefficients[3].status = CoefficientStatus::kNotExcited;  // u
  model.coefficients[3].estimate = 0.0;
  const auto xml = PrintVrx(model, VehicleWithMass());
  ASSERT_TRUE(xml);
  EXPECT_EQ(ElementOf(*xml, "xUU"), 0.0);
  EXPECT_EQ(ElementOf(*xml, "xU"), 0.0);
  EXPECT_THAT(*xml, AllOf(HasSubstr("has the sign of a push"), HasSubstr("not excited")));
}

TEST(Vrx, SaysLagAndDeadZoneAndKeepsItsComments) {
  Identification model = KnownBoat();
  model.vehicle_id = "boat--1---";
  model.structure = Structure::kFirstOrderDynamic;
  model.thruster_time_constant = MadeUpDynamicIdentification().thruster_time_constant;
  model.dead_zone = {0.05, -0.06};
  const auto xml = PrintVrx(model, VehicleWithMass());
  ASSERT_TRUE(xml);
  EXPECT_THAT(*xml, AllOf(HasSubstr("lag of 0.25 s"), HasSubstr("between -0.06 and 0.05")));
  std::istringstream lines(*xml);
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find("<!--");
    if (begin == std::string::npos) continue;
    const auto end = line.find("-->");
    ASSERT_NE(end, std::string::npos);
    EXPECT_THAT(line.substr(begin + 4, end - begin - 4), Not(HasSubstr("--"))) << line;
  }
}

TEST(Vrx, RefusesWithAdvice) {
  Vehicle vehicle = VehicleWithMass();
  vehicle.mass_kg.reset();
  const auto massless = PrintVrx(KnownBoat(), vehicle);
  ASSERT_FALSE(massless);
  EXPECT_THAT(massless.error().advice, HasSubstr("mass_kg"));

  Identification partial = KnownBoat();
  std::erase_if(partial.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  const auto n = static_cast<Eigen::Index>(partial.coefficients.size());
  partial.covariance = Eigen::MatrixXd::Identity(n, n);
  const auto incomplete = PrintVrx(partial, VehicleWithMass());
  ASSERT_FALSE(incomplete);
  EXPECT_THAT(incomplete.error().reason, HasSubstr("SWAY"));

  Identification reversed = KnownBoat();
  for (Coefficient& c : reversed.coefficients) {
    if (c.equation == Equation::kYaw) c.estimate = -c.estimate;
  }
  EXPECT_FALSE(PrintVrx(reversed, VehicleWithMass()));
}

// ---- mss ---------------------------------------------------------------------------------------

proto::MssModel ReadMss(const std::string& text) {
  proto::MssModel message;
  const auto fault = ParseJsonMessage(text, "mss", message);
  EXPECT_FALSE(fault) << fault->Message();
  return message;
}

TEST(Mss, HoldsEveryCoefficientWithItsMeaning) {
  for (const auto parameterization : {Parameterization::kPropeller, Parameterization::kPaper}) {
    const Identification model = MadeUpIdentification(parameterization);
    const proto::MssModel read = ReadMss(PrintMss(model, VehicleWithMass()));
    ASSERT_EQ(read.coefficients_size(), static_cast<int>(model.coefficients.size()));
    for (int i = 0; i < read.coefficients_size(); ++i) {
      EXPECT_EQ(read.coefficients(i).estimate(),
                model.coefficients[static_cast<std::size_t>(i)].estimate);
      EXPECT_THAT(read.coefficients(i).meaning(), HasSubstr("W"));
    }
    EXPECT_EQ(read.dead_zone().forward(), 0.05);
    EXPECT_EQ(read.propeller_separation_m(), 0.6);
  }
}

TEST(Mss, NamesWhatTelemetryDoesNotDetermine) {
  const std::string text = PrintMss(MadeUpDynamicIdentification(), VehicleWithMass());
  for (const char* parameter : {"X_udot", "Y_vdot", "N_rdot", "x_g", "I_z", "a_f"}) {
    EXPECT_THAT(text.substr(text.find("notIdentifiable")), HasSubstr(parameter));
  }
  EXPECT_THAT(text, HasSubstr("lower bound"));
  EXPECT_EQ(ReadMss(text).thruster_time_constant_s().estimate(), 0.25);
}

TEST(Mss, WithoutAMassThereIsNone) {
  Vehicle vehicle = VehicleWithMass();
  vehicle.mass_kg.reset();
  const proto::MssModel read = ReadMss(PrintMss(MadeUpIdentification(), vehicle));
  EXPECT_FALSE(read.has_mass_kg());
  for (const std::string& note : read.notes()) EXPECT_THAT(note, Not(HasSubstr("massKg")));
}

// ---- draws -------------------------------------------------------------------------------------

TEST(Draws, JsonAndCsvHoldTheSameBits) {
  const Identification model = MadeUpDynamicIdentification();
  const auto draws = DrawFromPosterior(model, 7, 3);
  ASSERT_TRUE(draws);
  proto::Draws read;
  ASSERT_FALSE(ParseJsonMessage(PrintDrawsJson(model, *draws, 3), "draws", read));
  ASSERT_EQ(read.draws_size(), 7);
  EXPECT_EQ(read.seed(), 3u);
  EXPECT_EQ(read.not_drawn(0), "SURGE vr");

  std::istringstream csv(PrintDrawsCsv(model, *draws));
  std::string line;
  std::getline(csv, line);
  EXPECT_THAT(line,
              AllOf(HasSubstr("SURGE u|u|,SURGE vr"), HasSubstr(",thruster_time_constant_s")));
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(std::getline(csv, line));
    std::istringstream cells(line);
    std::string cell;
    for (int j = 0; j < read.columns_size(); ++j) {
      ASSERT_TRUE(std::getline(cells, cell, ','));
      EXPECT_EQ(std::stod(cell), read.draws(i).coefficients(j));
      EXPECT_EQ(std::stod(cell), draws->theta(j, i));
    }
    ASSERT_TRUE(std::getline(cells, cell, ','));
    EXPECT_EQ(std::stod(cell), read.draws(i).thruster_time_constant_s());
  }
  EXPECT_FALSE(std::getline(csv, line));
}

}  // namespace
}  // namespace telltale
