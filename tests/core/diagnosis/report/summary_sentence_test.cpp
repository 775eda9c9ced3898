#include "telltale/core/diagnosis/report/summary_sentence.hpp"

#include <utility>

#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"

namespace telltale {
namespace {

/// A gap of twice the normal error, caused by late thrust with the given probability.
Diagnosis LateThrust(Verdict verdict, double probability) {
  Diagnosis diagnosis = MadeUpDiagnosis();
  for (Gap& gap : diagnosis.gaps) {
    gap.all.before = 2.0;
    gap.all.noise_floor = 1.0;
  }
  diagnosis.verdict = verdict;
  diagnosis.rest = "yaw, FR";
  Cause lag;
  lag.effects = {{"thruster_lag", {}, "thrust 0.15 s late", 1.0}};
  lag.probability = probability;
  lag.excess_explained = ExcessExplained{0.81, {0.95, 0.74, 0.87}};
  Cause unknown;
  unknown.probability = 1.0 - probability;
  diagnosis.causes = {lag, unknown};
  if (probability < 0.5) std::swap(diagnosis.causes[0], diagnosis.causes[1]);
  return diagnosis;
}

TEST(SummarySentence, NamesACertainCause) {
  EXPECT_EQ(SummarySentence(LateThrust(Verdict::kExplained, 0.9)),
            "Thrust 0.15 s late: 81 % [74, 87] of the gap; the rest is within noise.");
}

TEST(SummarySentence, GivesTheProbabilityOfAnUncertainCause) {
  EXPECT_EQ(SummarySentence(LateThrust(Verdict::kUnknownCause, 0.66)),
            "Most likely (66 %), but not certain, thrust 0.15 s late: 81 % [74, 87] of the gap.");
}

TEST(SummarySentence, ComparesWithReferencesWhereThereAreSome) {
  Diagnosis diagnosis = LateThrust(Verdict::kNoMaterialGap, 0.3);
  diagnosis.floor_basis = FloorBasis::kReferenceLogs;
  EXPECT_EQ(SummarySentence(diagnosis),
            "No material gap: the model matches the boat as well as on the references (2.0 times "
            "the normal error).");
  diagnosis.floor_basis = FloorBasis::kSensorNoise;
  EXPECT_EQ(SummarySentence(diagnosis),
            "No material gap: the model matches the boat as well as the sensors' noise allows (2.0 "
            "times the normal error).");
}

TEST(SummarySentence, NamesNoUnlikelyCause) {
  EXPECT_EQ(
      SummarySentence(LateThrust(Verdict::kUnknownCause, 0.3)),
      "The model no longer matches the boat (2.0 times the normal error), and no effect of the "
      "library explains it; the error sits in yaw, FR. Missing is a surge force that is -4.0 ± 0.8 "
      "N on headings of 0 to 36 deg.");
}

}  // namespace
}  // namespace telltale
