#include "telltale/core/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
std::string_view Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoMaterialGap: return "NO_MATERIAL_GAP";
    case Verdict::kExplained: return "EXPLAINED";
    case Verdict::kPartlyExplained: return "PARTLY_EXPLAINED";
    case Verdict::kUnknownCause: return "UNKNOWN_CAUSE";
    case Verdict::kInsufficientData: return "INSUFFICIENT_DATA";
    case Verdict::kUnknown: break;
  }
  return "UNKNOWN";
}

std::string_view Name(GapKind kind) {
  switch (kind) {
    case GapKind::kBias: return "BIAS";
    case GapKind::kSlope: return "SLOPE";
    case GapKind::kTiming: return "TIMING";
    case GapKind::kNoise: return "NOISE";
    case GapKind::kUnknown: break;
  }
  return "UNKNOWN";
}

std::string_view Name(ForceVariable variable) {
  switch (variable) {
    case ForceVariable::kSpeed: return "SPEED";
    case ForceVariable::kMeanCommand: return "MEAN_COMMAND";
    case ForceVariable::kCommandDifference: return "COMMAND_DIFFERENCE";
    case ForceVariable::kHeading: return "HEADING";
    case ForceVariable::kTime: return "TIME";
    case ForceVariable::kUnknown: break;
  }
  return "UNKNOWN";
}

std::string_view Name(DelayedChannel channel) {
  switch (channel) {
    case DelayedChannel::kCommands: return "COMMANDS";
    case DelayedChannel::kFixes: return "FIXES";
    case DelayedChannel::kUnknown: break;
  }
  return "UNKNOWN";
}

std::string_view Name(Testability testability) {
  switch (testability) {
    case Testability::kTestable: return "TESTABLE";
    case Testability::kMasked: return "ABSORBED";
    case Testability::kNotExcited: return "NOT_EXCITED";
    case Testability::kUnknown: break;
  }
  return "UNKNOWN";
}

const Gap& Diagnosis::Main() const {
  const auto main = std::find_if(gaps.begin(), gaps.end(), [](const Gap& gap) {
    return std::abs(gap.horizon_s - kDiagnosis.horizons.main_s) < 1e-6;
  });
  Require(main != gaps.end(), "a gap at five seconds");
  return *main;
}

}  // namespace telltale
