#include "telltale/idl/codec/wire/model.hpp"

#include <cstring>
#include <functional>
#include <utility>

#include <gtest/gtest.h>

#include "idl/codec/wire/wire_support.hpp"
#include "support/special_values.hpp"

namespace telltale {
namespace {

TEST(WireModel, ArrivesAsItWasSent) {
  const PublishedModel sent = MadeUpModel();
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ExpectSame(*received, sent);
}

TEST(WireModel, CarriesTheThrusterTimeConstant) {
  const PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ExpectSame(*received, sent);
}

TEST(WireModel, CarriesThePhysicalForm) {
  PublishedModel sent{MadeUpPhysicalIdentification(), 8, 1700000700.5};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ExpectSame(*received, sent);
}

TEST(WireModel, ExpectsThePhysicalFormOfFossenAlone) {
  const PublishedModel sent{MadeUpPhysicalIdentification(), 8, 1700000700.5};
  auto without = Encode(sent);
  without->physical._length = 0;
  EXPECT_EQ(Decode(*without).error().field, "physical");
  auto wire = Encode(sent);
  wire->physical._buffer[0].covariance._buffer[7] = kNan;
  EXPECT_EQ(Decode(*wire).error().field, "physical[0].covariance");
  wire = Encode(sent);
  wire->physical._buffer[0].covariance._length -= 1;
  EXPECT_EQ(Decode(*wire).error().value, "840 numbers");
  wire = Encode(sent);
  wire->physical._buffer[0].parameters._length -= 1;
  EXPECT_EQ(Decode(*wire).error().field, "physical[0].parameters");
  wire = Encode(sent);
  wire->physical._buffer[0].fix_sigma_m = 0.0;
  EXPECT_EQ(Decode(*wire).error().field, "physical[0].fix_sigma_m");
}

/// Expects that Decode refuses NaN in `numbers`, which it calls `field`, and one number too few.
void ExpectANumberForEachCoefficient(const PublishedModel& sent,
                                     dds_sequence_double telltale_wire_Model::*numbers,
                                     const std::string& field) {
  auto wire = Encode(sent);
  ((*wire).*numbers)._buffer[2] = kNan;
  EXPECT_EQ(Decode(*wire).error().field, field);
  wire = Encode(sent);
  ((*wire).*numbers)._length -= 1;
  EXPECT_EQ(Decode(*wire).error().value, "34 numbers");
}

TEST(WireModel, CarriesTheSimulationParameters) {
  const PublishedModel sent{MadeUpIdentificationWithSimulationParameters(), 8, 1700000700.5};
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  ExpectSame(*received, sent);
  ExpectANumberForEachCoefficient(sent, &telltale_wire_Model::simulation, "simulation");
}

TEST(WireModel, AnOlderWriterSendsNoCovarianceOfTheTimeConstant) {
  PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  sent.identification.time_constant_covariance.resize(0);
  const auto received = Decode(*Encode(sent));
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->identification.time_constant_covariance, Eigen::VectorXd::Zero(35));
}

TEST(WireModel, TheCovarianceOfTheTimeConstantHasANumberForEachCoefficient) {
  PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  ExpectANumberForEachCoefficient(sent, &telltale_wire_Model::thruster_time_constant_covariance,
                                  "thruster_time_constant_covariance");
  sent.identification.structure = Structure::kStaticQuadratic;
  sent.identification.thruster_time_constant.reset();
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant_covariance");
}

TEST(WireModel, TheTimeConstantGoesWithTheDynamicStructure) {
  PublishedModel sent{MadeUpDynamicIdentification(), 8, 1700000700.5};
  sent.identification.thruster_time_constant->estimate = 0.0;
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant[0].estimate");
  sent.identification.thruster_time_constant.reset();
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant");
  sent = {MadeUpDynamicIdentification(), 8, 1700000700.5};
  sent.identification.structure = Structure::kStaticQuadratic;
  EXPECT_EQ(Decode(*Encode(sent)).error().field, "thruster_time_constant");
}

struct Spoilt {
  const char* field;
  std::function<void(telltale_wire_Model&)> spoil;
};

TEST(WireModel, NamesTheFieldThatIsWrong) {
  const std::vector<Spoilt> cases = {
      {"vehicle_id", [](auto& m) { std::memset(m.vehicle_id, 'x', sizeof m.vehicle_id); }},
      {"structure", [](auto& m) { Replace(m.structure, "CUBIC"); }},
      {"structure", [](auto& m) { Replace(m.structure, nullptr); }},
      {"parameterization", [](auto& m) { Replace(m.parameterization, "UNKNOWN"); }},
      {"estimator", [](auto& m) { Replace(m.estimator, "GUESS"); }},
      {"sampling_period_s", [](auto& m) { m.sampling_period_s = 0.0; }},
      {"sampling_period_s", [](auto& m) { m.sampling_period_s = kNan; }},
      {"coefficients[3].equation",
       [](auto& m) { Replace(m.coefficients._buffer[3].equation, "HEAVE"); }},
      {"coefficients[3].status", [](auto& m) { Replace(m.coefficients._buffer[3].status, ""); }},
      {"coefficients[3].estimate", [](auto& m) { m.coefficients._buffer[3].estimate = kNan; }},
      {"coefficients[3].standard_error",
       [](auto& m) { m.coefficients._buffer[3].standard_error = -1.0; }},
      {"coefficients[3].bounds.level",
       [](auto& m) { m.coefficients._buffer[3].bounds.level = 1.5; }},
      {"coefficients[3].bounds.upper",
       [](auto& m) { m.coefficients._buffer[3].bounds.upper = -1e6; }},
      {"covariance", [](auto& m) { m.covariance._length -= 1; }},
      {"covariance[5]", [](auto& m) { m.covariance._buffer[5] = kNan; }},
      {"joint[0].covariance_factor", [](auto& m) { m.joint._buffer[0].covariance_factor = -1.0; }},
      {"joint[0].degrees_of_freedom",
       [](auto& m) { m.joint._buffer[0].degrees_of_freedom = kNan; }},
      {"dead_zone_forward", [](auto& m) { m.dead_zone_forward = 0.31; }},
      {"dead_zone_reverse", [](auto& m) { m.dead_zone_reverse = kNan; }},
      {"window_end_s", [](auto& m) { m.window_end_s = m.window_start_s - 1.0; }},
      {"rejected[0].reason", [](auto& m) { Replace(m.rejected._buffer[0].reason, "BORED"); }},
      {"rejected[0].channel", [](auto& m) { Replace(m.rejected._buffer[0].channel, "sonar"); }},
      {"published_unix_s", [](auto& m) { m.published_unix_s = kNan; }},
      {"misspecification", [](auto& m) { m.misspecification = -1.0; }},
  };
  for (const Spoilt& spoilt : cases) {
    auto wire = Encode(MadeUpModel());
    spoilt.spoil(*wire);
    const auto decoded = Decode(*wire);
    ASSERT_FALSE(decoded) << spoilt.field;
    EXPECT_EQ(decoded.error().field, spoilt.field);
    EXPECT_FALSE(decoded.error().allowed.empty());
  }
}

TEST(WireModel, RefusesCoefficientsOutOfOrder) {
  auto wire = Encode(MadeUpModel());
  std::swap(wire->coefficients._buffer[0], wire->coefficients._buffer[3]);
  EXPECT_EQ(Decode(*wire).error().field, "coefficients[0].regressor");
}

TEST(WireModel, RefusesACovarianceThatIsNotSymmetric) {
  auto wire = Encode(MadeUpModel());
  wire->covariance._buffer[70] = 5.0;
  EXPECT_EQ(Decode(*wire).error().field, "covariance[70]");
}

TEST(WireModel, RefusesASamplingPeriodThatNoFileMayHave) {
  auto wire = Encode(MadeUpModel());
  wire->sampling_period_s = 20.0;
  EXPECT_EQ(Decode(*wire).error().field, "sampling_period_s");
}

}  // namespace
}  // namespace telltale
