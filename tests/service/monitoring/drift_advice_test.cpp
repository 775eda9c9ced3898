#include "telltale/service/monitoring/drift_advice.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::EndsWith;
using ::testing::StartsWith;

constexpr char kAskWhy[] = "telltale diagnose --vehicle-id boat-1 asks why";

/// A boat that has drifted from revision 3 since the time 1000 s.
Quality Drifting() {
  Quality quality;
  quality.vehicle_id = "boat-1";
  quality.model_revision = 3;
  quality.drift_since_unix_s = 1000.0;
  quality.drift_evidence = "the errors of revision 3 show: port thruster 14 % weaker";
  return quality;
}

PublishedDiagnosis Answer(Verdict verdict) {
  Cause both;
  both.effects = {{"thruster_imbalance", {}, "port thruster 15 % weaker", 0.75},
                  {"thruster_lag", {}, "thrust 0.15 s late", 0.25}};
  PublishedDiagnosis diagnosis;
  diagnosis.diagnosis.verdict = verdict;
  diagnosis.diagnosis.causes = {Cause(), both};
  diagnosis.model_revision = 3;
  diagnosis.published_unix_s = 1600.0;
  return diagnosis;
}

TEST(DriftAdvice, AsksWhyUntilADiagnosisOfThisDriftIsThere) {
  EXPECT_EQ(DriftAdvice(Drifting(), nullptr), kAskWhy);
  PublishedDiagnosis answer = Answer(Verdict::kExplained);
  answer.published_unix_s = 999.0;
  EXPECT_EQ(DriftAdvice(Drifting(), &answer), kAskWhy);
  answer = Answer(Verdict::kExplained);
  answer.model_revision = 2;
  EXPECT_EQ(DriftAdvice(Drifting(), &answer), kAskWhy);
}

TEST(DriftAdvice, NamesWhatTheDiagnosisFoundAndWhatIsLeftToDo) {
  constexpr char kRefresh[] = "telltale refresh --vehicle-id boat-1";
  constexpr char kDiagnose[] = "telltale diagnose --vehicle-id boat-1 asks again";
  const struct {
    Verdict verdict;
    const char* found;
    const char* command;
  } cases[] = {
      {Verdict::kExplained, "port thruster 15 % weaker and thrust 0.15 s late: act", kRefresh},
      {Verdict::kPartlyExplained,
       "port thruster 15 % weaker and thrust 0.15 s late and an error without a known cause: act",
       kRefresh},
      {Verdict::kUnknownCause, "no certain cause: drive the manoeuvre", kDiagnose},
      {Verdict::kInsufficientData, "too little data: drive with more variation", kDiagnose},
      {Verdict::kNoMaterialGap, "no material gap: while the drift lasts", kDiagnose}};
  for (const auto& expected : cases) {
    const PublishedDiagnosis answer = Answer(expected.verdict);
    const std::string advice = DriftAdvice(Drifting(), &answer);
    EXPECT_THAT(advice, StartsWith("the diagnosis finds " + std::string(expected.found)));
    EXPECT_THAT(advice, EndsWith(expected.command));
  }
}

}  // namespace
}  // namespace telltale
