#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/identifiability.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/model.hpp"

namespace telltale {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::vector<Identification> MadeUpWithAndWithout() {
  return {WithIdentifiability(MadeUpIdentification(Parameterization::kPropeller)),
          WithIdentifiability(MadeUpIdentification(Parameterization::kPaper)),
          WithIdentifiability(MadeUpDynamicIdentification()), MadeUpIdentification()};
}

TEST(IdentifiabilityCodec, IsTheSameInJsonToTheLastBit) {
  for (const Identification& sent : MadeUpWithAndWithout()) {
    const auto read = ParseModelJson(PrintModelJson(sent));
    ASSERT_TRUE(read) << read.error().Message();
    ExpectSameIdentifiability(*read, sent);
  }
}

TEST(IdentifiabilityCodec, ArrivesOverTheWireAsItWasSent) {
  for (const Identification& sent : MadeUpWithAndWithout()) {
    const auto received = Decode(*Encode(PublishedModel{sent, 3, 1700000700.5}));
    ASSERT_TRUE(received) << received.error().Message();
    ExpectSameIdentifiability(received->identification, sent);
  }
}

TEST(IdentifiabilityCodec, HasTheNamesPeopleRead) {
  const std::string json = PrintModelJson(MadeUpWithAndWithout().front());
  for (const char* name :
       {"\"excitation\"", "\"condition\"", "\"varianceInflation\"", "\"leastSeparable\"",
        "\"effectiveRows\"", "\"advice\"", "\"manoeuvre\"", "\"durationS\"", "\"expectedNats\"",
        "\"expectedHalfWidth\"", "\"coverageCheck\"", "\"held\"", "\"total\"", "\"coverage\"",
        "\"biasStandardErrors\"", "\"jointInterval\"", "\"meanCoverage\"",
        "\"truthIsReportedModel\""}) {
    EXPECT_THAT(json, testing::HasSubstr(name));
  }
}

struct SpoiltMessage {
  const char* field;
  std::function<void(proto::Model&)> spoil;
};

TEST(IdentifiabilityCodec, WrongFieldsOfAFileAreNamed) {
  const std::vector<SpoiltMessage> cases = {
      {"excitation[1].equation",
       [](auto& m) { m.mutable_excitation(1)->set_equation(proto::UNKNOWN_EQUATION); }},
      {"excitation[0].condition", [](auto& m) { m.mutable_excitation(0)->set_condition(0.5); }},
      {"excitation[0].varianceInflation[2].regressor",
       [](auto& m) {
         m.mutable_excitation(0)->mutable_variance_inflation(2)->set_regressor("u^3");
       }},
      {"excitation[2].leastSeparable[0].weight",
       [](auto& m) { m.mutable_excitation(2)->mutable_least_separable(0)->set_weight(1.5); }},
      {"excitation[0].effectiveRows",
       [](auto& m) { m.mutable_excitation(0)->set_effective_rows(kNotANumber); }},
      {"advice[0].durationS", [](auto& m) { m.mutable_advice(0)->set_duration_s(-1.0); }},
      {"advice[0].expected[1].expectedHalfWidth",
       [](auto& m) {
         m.mutable_advice(0)->mutable_expected(1)->set_expected_half_width(kNotANumber);
       }},
      {"coverageCheck.replicatesIdentified",
       [](auto& m) { m.mutable_coverage_check()->set_replicates_identified(101); }},
      {"coverageCheck.coefficients",
       [](auto& m) { m.mutable_coverage_check()->mutable_coefficients()->RemoveLast(); }},
      {"coverageCheck.coefficients[3].held",
       [](auto& m) { m.mutable_coverage_check()->mutable_coefficients(3)->set_held(99); }},
      {"coverageCheck.meanCoverage",
       [](auto& m) { m.mutable_coverage_check()->set_mean_coverage(1.01); }}};
  for (const SpoiltMessage& spoilt : cases) {
    proto::Model message = ToProto(MadeUpWithAndWithout().front());
    spoilt.spoil(message);
    const auto read = IdentificationOf(message);
    ASSERT_FALSE(read) << spoilt.field;
    EXPECT_EQ(read.error().field, spoilt.field);
    EXPECT_FALSE(read.error().allowed.empty());
  }
}

struct SpoiltWire {
  const char* field;
  std::function<void(telltale_wire_Model&)> spoil;
};

TEST(IdentifiabilityCodec, WrongFieldsOnTheWireAreNamed) {
  const std::vector<SpoiltWire> cases = {
      {"excitation[0].condition", [](auto& m) { m.excitation._buffer[0].condition = kNotANumber; }},
      {"excitation[1].variance_inflation",
       [](auto& m) { m.excitation._buffer[1].variance_inflation._length = 3; }},
      {"excitation[0].least_separable[1].weight",
       [](auto& m) { m.excitation._buffer[0].least_separable._buffer[1].weight = 2.0; }},
      {"advice[0].expected_nats", [](auto& m) { m.advice._buffer[0].expected_nats = kNotANumber; }},
      {"advice[0].expected[0].half_width",
       [](auto& m) { m.advice._buffer[0].expected._buffer[0].half_width = -1.0; }},
      {"coverage_check[0].replicates_identified",
       [](auto& m) { m.coverage_check._buffer[0].replicates_identified = 101; }},
      {"coverage_check[0].coefficients",
       [](auto& m) { m.coverage_check._buffer[0].coefficients._length = 1; }},
      {"coverage_check[0].joint_held",
       [](auto& m) { m.coverage_check._buffer[0].joint_held = 97; }}};
  for (const SpoiltWire& spoilt : cases) {
    auto wire = Encode(PublishedModel{MadeUpWithAndWithout().front(), 3, 1700000700.5});
    spoilt.spoil(*wire);
    const auto received = Decode(*wire);
    ASSERT_FALSE(received) << spoilt.field;
    EXPECT_EQ(received.error().field, spoilt.field);
  }
}

TEST(IdentifiabilityCodec, ARequestAsksForACoverageCheck) {
  IdentifyRequest sent;
  sent.correlation_id = "abc-1";
  sent.vehicle_id = "boat-1";
  EXPECT_EQ(Decode(*Encode(sent))->coverage_check_replicates, 0u);
  sent.coverage_check_replicates = 100;
  EXPECT_EQ(Decode(*Encode(sent))->coverage_check_replicates, 100u);
}

}  // namespace
}  // namespace telltale
