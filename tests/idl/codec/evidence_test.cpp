#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/evidence.hpp"
#include "support/identifications.hpp"
#include "telltale/idl/codec/model_json.hpp"
#include "telltale/idl/codec/wire.hpp"

namespace telltale {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::vector<Identification> MadeUpWithAndWithout() {
  return {WithEvidence(MadeUpIdentification(Parameterization::kPropeller)),
          WithEvidence(MadeUpIdentification(Parameterization::kPaper)),
          WithEvidence(MadeUpDynamicIdentification()), MadeUpIdentification()};
}

TEST(Evidence, IsTheSameInJsonToTheLastBit) {
  for (const Identification& sent : MadeUpWithAndWithout()) {
    const auto read = ParseModelJson(PrintModelJson(sent));
    ASSERT_TRUE(read) << read.error().Message();
    ExpectSameEvidence(*read, sent);
  }
}

TEST(Evidence, ArrivesOverTheWireAsItWasSent) {
  for (const Identification& sent : MadeUpWithAndWithout()) {
    const auto received = Decode(*Encode(PublishedModel{sent, 3, 1700000700.5}));
    ASSERT_TRUE(received) << received.error().Message();
    ExpectSameEvidence(received->identification, sent);
  }
}

TEST(Evidence, HasTheNamesPeopleRead) {
  const std::string json = PrintModelJson(MadeUpWithAndWithout().front());
  for (const char* name :
       {"\"excitation\"", "\"condition\"", "\"varianceInflation\"", "\"leastSeparable\"",
        "\"effectiveRows\"", "\"advice\"", "\"manoeuvre\"", "\"durationS\"", "\"expectedNats\"",
        "\"expectedHalfWidth\"", "\"certificate\"", "\"held\"", "\"total\"", "\"coverage\"",
        "\"biasStandardErrors\"", "\"jointInterval\"", "\"meanCoverage\"",
        "\"aboutPublishedModel\""}) {
    EXPECT_THAT(json, testing::HasSubstr(name));
  }
}

struct SpoiltMessage {
  const char* field;
  std::function<void(proto::Model&)> spoil;
};

TEST(Evidence, WrongFieldsOfAFileAreNamed) {
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
      {"certificate.answered", [](auto& m) { m.mutable_certificate()->set_answered(101); }},
      {"certificate.coefficients",
       [](auto& m) { m.mutable_certificate()->mutable_coefficients()->RemoveLast(); }},
      {"certificate.coefficients[3].held",
       [](auto& m) { m.mutable_certificate()->mutable_coefficients(3)->set_held(99); }},
      {"certificate.meanCoverage",
       [](auto& m) { m.mutable_certificate()->set_mean_coverage(1.01); }}};
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

TEST(Evidence, WrongFieldsOnTheWireAreNamed) {
  const std::vector<SpoiltWire> cases = {
      {"excitation[0].condition", [](auto& m) { m.excitation._buffer[0].condition = kNotANumber; }},
      {"excitation[1].variance_inflation",
       [](auto& m) { m.excitation._buffer[1].variance_inflation._length = 3; }},
      {"excitation[0].least_separable[1].weight",
       [](auto& m) { m.excitation._buffer[0].least_separable._buffer[1].weight = 2.0; }},
      {"advice[0].expected_nats", [](auto& m) { m.advice._buffer[0].expected_nats = kNotANumber; }},
      {"advice[0].expected[0].half_width",
       [](auto& m) { m.advice._buffer[0].expected._buffer[0].half_width = -1.0; }},
      {"certificate[0].answered", [](auto& m) { m.certificate._buffer[0].answered = 101; }},
      {"certificate[0].coefficients",
       [](auto& m) { m.certificate._buffer[0].coefficients._length = 1; }},
      {"certificate[0].joint_held", [](auto& m) { m.certificate._buffer[0].joint_held = 97; }}};
  for (const SpoiltWire& spoilt : cases) {
    auto wire = Encode(PublishedModel{MadeUpWithAndWithout().front(), 3, 1700000700.5});
    spoilt.spoil(*wire);
    const auto received = Decode(*wire);
    ASSERT_FALSE(received) << spoilt.field;
    EXPECT_EQ(received.error().field, spoilt.field);
  }
}

TEST(Evidence, ARequestAsksForACertificate) {
  IdentifyRequest sent;
  sent.correlation_id = "abc-1";
  sent.vehicle_id = "boat-1";
  EXPECT_EQ(Decode(*Encode(sent))->certificate_twins, 0u);
  sent.certificate_twins = 100;
  EXPECT_EQ(Decode(*Encode(sent))->certificate_twins, 100u);
}

}  // namespace
}  // namespace telltale
