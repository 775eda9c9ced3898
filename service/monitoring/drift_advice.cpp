#include "telltale/service/monitoring/drift_advice.hpp"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

namespace telltale {
namespace {

bool IsAboutTheDrift(const PublishedDiagnosis& diagnosis, const Quality& quality) {
  return diagnosis.model_revision == quality.model_revision &&
         diagnosis.published_unix_s >= quality.drift_since_unix_s;
}

/// "port thruster 22 % weaker and thrust 0.15 s late": the most probable cause with a name.
std::string CauseOf(const Diagnosis& diagnosis) {
  const auto named = std::ranges::find_if(
      diagnosis.causes, [](const Cause& cause) { return !cause.effects.empty(); });
  std::string text;
  if (named == diagnosis.causes.end()) return text;
  for (const CausalEffect& effect : named->effects) {
    text.append(text.empty() ? "" : " and ").append(effect.sentence);
  }
  return text;
}

/// What the diagnosis found, and what that leaves to do.
std::string NextStep(const Diagnosis& diagnosis, const std::string& vehicle_id) {
  const std::string act =
      "act on it, or identify the boat as it is now with telltale refresh "
      "--vehicle-id " +
      vehicle_id;
  const std::string ask = "telltale diagnose --vehicle-id " + vehicle_id + " asks again";
  switch (diagnosis.verdict) {
    case Verdict::kExplained: return CauseOf(diagnosis) + ": " + act;
    case Verdict::kPartlyExplained:
      return CauseOf(diagnosis) + " and an error without a known cause: " + act;
    case Verdict::kUnknownCause:
      return "no certain cause: drive the manoeuvre that it recommends, then " + ask;
    case Verdict::kInsufficientData:
      return "too little data: drive with more variation, then " + ask;
    case Verdict::kNoMaterialGap:
    case Verdict::kUnknown: break;
  }
  return "no material gap: while the drift lasts, " + ask;
}

}  // namespace

std::string DriftAdvice(const Quality& quality, const PublishedDiagnosis* diagnosis) {
  if (!diagnosis || !IsAboutTheDrift(*diagnosis, quality)) {
    return fmt::format("telltale diagnose --vehicle-id {} asks why", quality.vehicle_id);
  }
  return "the diagnosis finds " + NextStep(diagnosis->diagnosis, quality.vehicle_id);
}

}  // namespace telltale
