#include "telltale/idl/codec/json/model.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "support/test_name.hpp"
#include "telltale/core/identification/drag_and_thrust.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;

void ExpectReadsBack(const Identification& identification) {
  const auto again = ParseModelJson(PrintModelJson(identification));
  ASSERT_TRUE(again) << again.error().Message();
  ExpectSame(*again, identification);
}

TEST(ModelJson, PrintedAndReadAgainIsTheSameToTheLastBit) {
  ExpectReadsBack(MadeUpIdentification(Parameterization::kPropeller));
  ExpectReadsBack(MadeUpIdentification(Parameterization::kPaper));
  ExpectReadsBack(MadeUpIdentificationWithSimulationParameters());
}

TEST(ModelJson, AnEquationMayBeMissingWhole) {
  Identification partial = MadeUpIdentification();
  std::erase_if(partial.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  const auto n = static_cast<Eigen::Index>(partial.coefficients.size());
  partial.covariance = Eigen::MatrixXd::Identity(n, n);
  ExpectReadsBack(partial);
}

TEST(ModelJson, TheTimeConstantGoesWithTheDynamicStructure) {
  ExpectReadsBack(MadeUpDynamicIdentification());
}

TEST(ModelJson, ThePhysicalFormGoesWithItsStructure) {
  ExpectReadsBack(MadeUpPhysicalIdentification());
  proto::Model model = ToProto(MadeUpPhysicalIdentification());
  model.set_structure(proto::FIRST_ORDER_DYNAMIC);
  EXPECT_EQ(IdentificationOf(model).error().field, "parameters");
}

TEST(ModelJson, ThePhysicalFormSaysWhatItsDragAndThrustComeTo) {
  const Identification sent = MadeUpPhysicalIdentification();
  const proto::Model model = ToProto(sent);
  const auto forces = DragAndThrustOf(*sent.physical);
  ASSERT_EQ(model.drag_and_thrust_size(), std::ssize(forces));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const proto::ForceAtPoint& written = model.drag_and_thrust(static_cast<int>(i));
    EXPECT_EQ(written.name(), forces[i].name);
    EXPECT_EQ(written.at(), forces[i].at);
    EXPECT_EQ(written.at_unit(), forces[i].at_unit);
    EXPECT_EQ(written.estimate(), forces[i].estimate);
    EXPECT_TRUE(std::isfinite(written.interval().lower())) << written.name();
    EXPECT_TRUE(std::isfinite(written.interval().upper())) << written.name();
    EXPECT_EQ(written.unit(), forces[i].unit);
  }
}

TEST(ModelJson, ThePhysicalFormHasEveryParameterByItsName) {
  proto::Model model = ToProto(MadeUpPhysicalIdentification());
  model.mutable_parameters(2)->set_symbol("m44");
  EXPECT_EQ(IdentificationOf(model).error().value, "\"m44\"");
  EXPECT_EQ(IdentificationOf(model).error().allowed, "\"m33\"");
  model.mutable_parameters()->RemoveLast();
  EXPECT_EQ(IdentificationOf(model).error().value, "28 items");
}

TEST(ModelJson, ThePhysicalFormHasACovarianceAndANoiseThatFilter) {
  proto::Model model = ToProto(MadeUpPhysicalIdentification());
  model.mutable_parameter_covariance()->RemoveLast();
  EXPECT_EQ(IdentificationOf(model).error().field, "parameterCovariance");
  model = ToProto(MadeUpPhysicalIdentification());
  model.mutable_filter_noise()->set_fix_sigma_m(0.0);
  EXPECT_EQ(IdentificationOf(model).error().field, "filterNoise.fixSigmaM");
  model = ToProto(MadeUpPhysicalIdentification());
  model.set_propeller_separation_m(-1.0);
  EXPECT_EQ(IdentificationOf(model).error().field, "propellerSeparationM");
}

TEST(ModelJson, AnOlderFileHasNoCovarianceOfTheTimeConstant) {
  proto::Model model = ToProto(MadeUpDynamicIdentification());
  model.clear_thruster_time_constant_covariance();
  const auto read = IdentificationOf(model);
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(read->time_constant_covariance, Eigen::VectorXd::Zero(35));
}

TEST(ModelJson, TheCovarianceOfTheTimeConstantHasANumberForEachCoefficient) {
  proto::Model model = ToProto(MadeUpDynamicIdentification());
  model.set_thruster_time_constant_covariance(3, kNan);
  EXPECT_EQ(IdentificationOf(model).error().field, "thrusterTimeConstantCovariance[3]");
  model.mutable_thruster_time_constant_covariance()->RemoveLast();
  EXPECT_EQ(IdentificationOf(model).error().field, "thrusterTimeConstantCovariance");
  EXPECT_EQ(IdentificationOf(model).error().value, "34 numbers");
  EXPECT_THAT(PrintModelJson(MadeUpDynamicIdentification()),
              HasSubstr("\"thrusterTimeConstantCovariance\": ["));
}

// 34 coefficients of the made-up model are bounded; F(34, 66 - 34 + 1) at 95 % is 1.7825 by
// scipy.stats.f.ppf(0.95, 34, 33).
TEST(ModelJson, SaysHowFarTheTruthOfAllCoefficientsMayLie) {
  proto::Model model = ToProto(MadeUpIdentification());
  EXPECT_NEAR(model.joint().squared_radius(), 34.0 * 1.7825 / 0.7, 0.01);
  model.clear_joint();
  const auto older = IdentificationOf(model);
  ASSERT_TRUE(older) << older.error().Message();
  EXPECT_FALSE(older->joint);
}

TEST(ModelJson, AnOlderFileHasNoDeadZone) {
  proto::Model model = ToProto(MadeUpIdentification());
  model.clear_dead_zone();
  const auto read = IdentificationOf(model);
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(read->dead_zone, DeadZone{});
}

TEST(ModelJson, RefusesADeadZoneOutOfItsRange) {
  for (const auto& [forward, reverse, field] :
       {std::tuple{0.31, 0.0, "deadZone.forward"}, std::tuple{-0.01, 0.0, "deadZone.forward"},
        std::tuple{0.0, 0.01, "deadZone.reverse"}, std::tuple{0.0, kNan, "deadZone.reverse"}}) {
    proto::Model model = ToProto(MadeUpIdentification());
    model.mutable_dead_zone()->set_forward(forward);
    model.mutable_dead_zone()->set_reverse(reverse);
    const auto read = IdentificationOf(model);
    ASSERT_FALSE(read) << field;
    EXPECT_EQ(read.error().field, field);
  }
}

TEST(ModelJson, RefusesAMisspecificationThatIsNoRatio) {
  proto::Model model = ToProto(MadeUpIdentification());
  model.mutable_provenance()->set_misspecification(kNan);
  ASSERT_FALSE(IdentificationOf(model));
  EXPECT_EQ(IdentificationOf(model).error().field, "provenance.misspecification");
}

TEST(ModelJson, NamesTheRecordingsThatMadeIt) {
  Identification made = MadeUpIdentification();
  made.provenance.recordings = {{"monday", 100.0, 400.25, 1501, {1U, 4294967295U}},
                                {"tuesday", -3.5, 60.0, 300, {}}};
  const auto read = ParseModelJson(PrintModelJson(made));
  ASSERT_TRUE(read) << read.error().Message();
  const auto& recordings = read->provenance.recordings;
  ASSERT_EQ(recordings.size(), 2U);
  EXPECT_EQ(recordings[0].name, "monday");
  EXPECT_EQ(recordings[0].start_s, 100.0);
  EXPECT_EQ(recordings[0].end_s, 400.25);
  EXPECT_EQ(recordings[0].fixes, 1501U);
  EXPECT_EQ(recordings[0].marks, made.provenance.recordings[0].marks);
  EXPECT_EQ(recordings[1].start_s, -3.5);
  EXPECT_TRUE(recordings[1].marks.empty());
}

TEST(ModelJson, UsesTheNamesOfTheInterface) {
  const std::string json = PrintModelJson(MadeUpIdentification());
  for (const char* text : {"\"vehicleId\": \"made-up.1\"",
                           "\"structure\": \"STATIC_QUADRATIC\"",
                           "\"parameterization\": \"PROPELLER\"",
                           "\"estimator\": \"ONE_STEP\"",
                           "\"samplingPeriodS\": 0.2",
                           "\"equation\": \"SURGE\"",
                           "\"regressor\": \"u|u|\"",
                           "\"symbol\": \"Pu11\"",
                           "\"standardError\": \"Infinity\"",
                           "\"lower\": \"-Infinity\"",
                           "\"unit\": \"1/m\"",
                           "\"status\": \"NOT_EXCITED\"",
                           "\"startS\": 1700000000.125",
                           "\"samples\": 3003",
                           "\"channel\": \"gnss\"",
                           "\"reason\": \"DUPLICATE\"",
                           "\"count\": 7",
                           "\"advice\": \"add a zigzag at two speeds\"",
                           "\"seed\": \"18446744073709551615\"",
                           "\"estimatorChoice\": \"the boat lay in a harbour\"",
                           "\"misspecification\": 1.125"}) {
    EXPECT_THAT(json, HasSubstr(text));
  }
}

// The codec casts between the enumerations, so their order must agree.
TEST(ModelJson, EnumerationsHaveTheSameNamesInProtobuf) {
  for (const Equation value : kEquations) {
    EXPECT_EQ(proto::Equation_Name(static_cast<int>(value)), Name(value));
  }
  for (const Structure value : {Structure::kStaticQuadratic, Structure::kFirstOrderDynamic}) {
    EXPECT_EQ(proto::Structure_Name(static_cast<int>(value)), Name(value));
  }
  for (const Parameterization value : {Parameterization::kPropeller, Parameterization::kPaper}) {
    EXPECT_EQ(proto::Parameterization_Name(static_cast<int>(value)), Name(value));
  }
  EXPECT_EQ(static_cast<int>(Estimator::kOneStep), proto::ONE_STEP);
  EXPECT_EQ(static_cast<int>(Estimator::kWeakIv), proto::WEAK_IV);
  EXPECT_EQ(static_cast<int>(Estimator::kOutputError), proto::OUTPUT_ERROR);
  EXPECT_EQ(static_cast<int>(CoefficientStatus::kEstimated), proto::ESTIMATED);
  EXPECT_EQ(static_cast<int>(CoefficientStatus::kNotExcited), proto::NOT_EXCITED);
  EXPECT_EQ(static_cast<int>(CoefficientStatus::kCollinear), proto::COLLINEAR);
  for (const auto value : {ChangeVerdict::kNoSignificantChange, ChangeVerdict::kChanged,
                           ChangeVerdict::kInconclusive}) {
    EXPECT_EQ(proto::ChangeVerdict_Name(static_cast<int>(value)), Name(value));
  }
}

struct ModelFault {
  std::function<void(proto::Model&)> spoil;
  std::string field, value, allowed;
};

void PrintTo(const ModelFault& fault, std::ostream* out) {
  *out << AsTestName(fault.field + ' ' + fault.value + ' ' + fault.allowed);
}

class WrongModel : public testing::TestWithParam<ModelFault> {};

TEST_P(WrongModel, IsRefusedNamingFieldValueAndWhatIsAllowed) {
  const ModelFault& fault = GetParam();
  proto::Model model = ToProto(MadeUpIdentification());
  fault.spoil(model);
  const auto identification = IdentificationOf(model, "model.json");
  ASSERT_FALSE(identification);
  EXPECT_EQ(identification.error().field, fault.field);
  EXPECT_EQ(identification.error().value, fault.value);
  EXPECT_THAT(identification.error().allowed, HasSubstr(fault.allowed));
  EXPECT_EQ(identification.error().where, "model.json");
}

using M = proto::Model;

INSTANTIATE_TEST_SUITE_P(
    ModelJson, WrongModel,
    testing::Values(
        ModelFault{[](M& m) { m.set_vehicle_id("a b"); }, "vehicleId", "\"a b\"", "letters"},
        ModelFault{[](M& m) { m.clear_structure(); }, "structure", "", "STATIC_QUADRATIC"},
        ModelFault{[](M& m) { m.set_structure(static_cast<proto::Structure>(9)); }, "structure",
                   "9", "STATIC_QUADRATIC"},
        ModelFault{[](M& m) { m.clear_parameterization(); }, "parameterization", "", "PAPER"},
        ModelFault{[](M& m) { m.clear_estimator(); }, "estimator", "", "ONE_STEP"},
        ModelFault{[](M& m) { m.set_sampling_period_s(0.0); }, "samplingPeriodS", "0",
                   "[0.001, 10]"},
        ModelFault{[](M& m) { m.clear_coefficients(), m.clear_covariance(); }, "coefficients",
                   "(none)", "at least one equation"},
        ModelFault{[](M& m) { m.mutable_coefficients(3)->set_regressor("u^7"); },
                   "coefficients[3].regressor", "\"u^7\"", "\"u\""},
        ModelFault{[](M& m) { m.mutable_coefficients(3)->set_symbol("X"); },
                   "coefficients[3].symbol", "\"X\"", "\"Ru1\""},
        ModelFault{[](M& m) { m.mutable_coefficients(3)->set_unit("1/h"); }, "coefficients[3].unit",
                   "\"1/h\"", "\"1/s\""},
        ModelFault{[](M& m) { m.mutable_coefficients()->SwapElements(0, 3); },
                   "coefficients[0].regressor", "\"u\"", "\"u|u|\""},
        ModelFault{[](M& m) { m.mutable_coefficients()->SwapElements(0, 9); },
                   "coefficients[1].equation", "SURGE", "SWAY, whose regressor"},
        ModelFault{[](M& m) {
                     auto& all = *m.mutable_coefficients();
                     std::rotate(all.pointer_begin(), all.pointer_begin() + 9, all.pointer_end());
                   },
                   "coefficients[26].equation", "SURGE", "in this order"},
        ModelFault{[](M& m) { m.mutable_coefficients(0)->set_equation(proto::UNKNOWN_EQUATION); },
                   "coefficients[0].equation", "UNKNOWN", "SURGE"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->set_estimate(kNan); },
                   "coefficients[4].estimate", "nan", "number"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->set_estimate(kInfinity); },
                   "coefficients[4].estimate", "inf", "number"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->set_standard_error(-1); },
                   "coefficients[4].standardError", "-1", "[0, inf]"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->clear_interval(); },
                   "coefficients[4].interval", "", "required"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->mutable_interval()->set_level(1.5); },
                   "coefficients[4].interval.level", "1.5", "(0, 1]"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->mutable_interval()->set_lower(9); },
                   "coefficients[4].interval.lower", "9", "not above upper"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->mutable_interval()->set_upper(kNan); },
                   "coefficients[4].interval.upper", "nan", "number"},
        ModelFault{[](M& m) { m.mutable_coefficients(4)->clear_status(); },
                   "coefficients[4].status", "", "NOT_EXCITED"},
        ModelFault{[](M& m) { m.mutable_covariance()->RemoveLast(); }, "covariance", "1224 numbers",
                   "1225"},
        ModelFault{[](M& m) { m.mutable_joint()->set_covariance_factor(0.0); },
                   "joint.covarianceFactor", "0", "(0, "},
        ModelFault{[](M& m) { m.mutable_joint()->set_degrees_of_freedom(kNan); },
                   "joint.degreesOfFreedom", "nan", "[1, "},
        ModelFault{[](M& m) { m.add_simulation(1.0); }, "simulation", "1 numbers", "35"},
        ModelFault{[](M& m) {
                     while (m.simulation_size() < 35) m.add_simulation(kNan);
                   },
                   "simulation[0]", "nan", "number"},
        ModelFault{[](M& m) { m.set_covariance(1, kNan); }, "covariance[1]", "nan", "number"},
        ModelFault{[](M& m) { m.set_covariance(0, -1.0); }, "covariance[0]", "-1", "[0, inf]"},
        ModelFault{[](M& m) { m.set_covariance(70, 5.0); }, "covariance[70]", "5", "symmetric"},
        ModelFault{[](M& m) { m.mutable_thruster_time_constant_s()->set_estimate(1.0); },
                   "thrusterTimeConstantS", "(given)", "FIRST_ORDER_DYNAMIC"},
        ModelFault{[](M& m) { m.add_thruster_time_constant_covariance(1.0); },
                   "thrusterTimeConstantCovariance", "1 numbers", "FIRST_ORDER_DYNAMIC"},
        ModelFault{[](M& m) { m.set_structure(proto::FIRST_ORDER_DYNAMIC); },
                   "thrusterTimeConstantS", "", "FIRST_ORDER_DYNAMIC"},
        ModelFault{[](M& m) { m.mutable_provenance()->mutable_change()->clear_verdict(); },
                   "provenance.change.verdict", "", "DIFFERS"},
        ModelFault{[](M& m) { m.mutable_provenance()->mutable_change()->set_p_value(1.5); },
                   "provenance.change.pValue", "1.5", "[0, 1]"},
        ModelFault{
            [](M& m) {
              m.mutable_provenance()->mutable_change()->mutable_coefficients(1)->set_standard_error(
                  0.0);
            },
            "provenance.change.coefficients[1].standardError", "0", "(0,"},
        ModelFault{[](M& m) { m.mutable_window()->set_end_s(1.0); }, "window.startS",
                   "1700000000.125", "not after endS = 1"},
        ModelFault{[](M& m) { m.mutable_window()->set_start_s(kNan); }, "window.startS", "nan",
                   "number"},
        ModelFault{[](M& m) { m.mutable_window()->mutable_rejected(0)->set_channel("sonar"); },
                   "window.rejected[0].channel", "\"sonar\"", "gnss, heading, thrusters"},
        ModelFault{[](M& m) { m.mutable_window()->mutable_rejected(1)->set_reason("UGLY"); },
                   "window.rejected[1].reason", "\"UGLY\"", "NOT_FINITE"}));

TEST(ModelJson, AnEquationThatEndsEarlyIsRefused) {
  proto::Model model = ToProto(MadeUpIdentification());
  model.mutable_coefficients()->RemoveLast();
  model.mutable_covariance()->Truncate(34 * 34);
  model.mutable_covariance()->Resize(34 * 34, 0.0);
  for (int i = 0; i < 34 * 34; ++i) model.set_covariance(i, 0.0);
  const auto identification = IdentificationOf(model);
  ASSERT_FALSE(identification);
  EXPECT_EQ(identification.error().field, "coefficients");
  EXPECT_THAT(identification.error().allowed, HasSubstr("\"r:d\""));
}

TEST(ModelJson, TextThatIsNotAModelIsRefusedWithWhatIsWrong) {
  const auto fault = [](const char* text) { return ParseModelJson(text, "m.json").error(); };
  EXPECT_EQ(fault("{\"foo\": 1}").field, "foo");
  EXPECT_EQ(fault("{\"coefficients\": [{\"foo\": 1}]}").field, "coefficients[0].foo");
  EXPECT_EQ(fault("{\"structure\": \"CUBIC\"}").field, "structure");
  EXPECT_EQ(fault("{\"structure\": \"CUBIC\"}").value, "\"CUBIC\"");
  EXPECT_EQ(fault("{\"structure\": \"CUBIC\"}").allowed,
            "one of STATIC_QUADRATIC, FIRST_ORDER_DYNAMIC, FOSSEN");
  EXPECT_EQ(fault("{\"samplingPeriodS\": \"soon\"}").allowed, "a number");
  EXPECT_EQ(fault("{\"window\": {\"samples\": -3}}").field, "window.samples");
  for (const char* text : {"", "{", "[1]", "null", "{\"covariance\": [1e999]}", "\xff"}) {
    EXPECT_EQ(fault(text).where, "m.json") << text;
  }
}

}  // namespace
}  // namespace telltale
