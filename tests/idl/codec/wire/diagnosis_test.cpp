#include "telltale/idl/codec/wire/diagnosis.hpp"

#include <cstring>

#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"

namespace telltale {
namespace {

TEST(WireDiagnosis, ArrivesAsItWasSent) {
  const PublishedDiagnosis sent{MadeUpDiagnosis(), 7, 1700000700.5};
  const auto wire = Encode(sent);
  EXPECT_STREQ(wire->verdict, "PARTLY_EXPLAINED");
  EXPECT_EQ(wire->sentence, sent.diagnosis.sentence);
  const auto received = Decode(*wire);
  ASSERT_TRUE(received) << received.error().Message();
  EXPECT_EQ(received->model_revision, 7u);
  EXPECT_EQ(received->published_unix_s, 1700000700.5);
  ExpectSame(received->diagnosis, sent.diagnosis);
}

TEST(WireDiagnosis, RefusesAReportThatIsNoneOrOfAnotherVehicle) {
  auto wire = Encode(PublishedDiagnosis{MadeUpDiagnosis(), 7, 1700000700.5});
  std::strcpy(wire->vehicle_id, "another");
  EXPECT_EQ(Decode(*wire).error().field, "vehicle_id");
  wire->report[0] = 'x';
  EXPECT_FALSE(Decode(*wire));
}

}  // namespace
}  // namespace telltale
