#include "telltale/service/upkeep/upkeep_rules.hpp"

#include <cmath>

#include <spdlog/fmt/fmt.h>

namespace telltale {
namespace {

constexpr double kDiagnosedDriftS = 90.0;

std::string SpanText(double span_s) {
  if (span_s < 120.0) return fmt::format("{:.0f} s", span_s);
  if (span_s < 7200.0) return fmt::format("{:.0f} min", span_s / 60.0);
  if (span_s < 172800.0) return fmt::format("{:.0f} h", span_s / 3600.0);
  return fmt::format("{:.0f} d", span_s / 86400.0);
}

}  // namespace

UpkeepRules::UpkeepRules(const UpkeepSettings& settings, double start_unix_s)
    : settings_(settings), start_unix_s_(start_unix_s) {}

UpkeepStep UpkeepRules::Consider(const std::string& vehicle_id, const UpkeepFacts& facts,
                                 double now_unix_s) {
  Vehicle& vehicle = vehicles_[vehicle_id];
  UpkeepStep step;
  if (!facts.has_telemetry) return step;
  if (NeedsDiagnosis(vehicle, facts)) {
    step.diagnose = true;
    vehicle.diagnosed_unix_s = now_unix_s;
    vehicle.diagnosed_revision = facts.revision;
  }
  const bool tried = IsRecent(vehicle.refreshed_unix_s, now_unix_s);
  if (settings_.refresh == RefreshMode::kOff || tried) return step;
  step.refresh = RefreshReason(vehicle, facts, now_unix_s);
  if (step.refresh.empty()) return step;
  vehicle.refreshed_unix_s = now_unix_s;
  vehicle.rounds = Rounds(now_unix_s);
  return step;
}

bool UpkeepRules::NeedsDiagnosis(const Vehicle& vehicle, const UpkeepFacts& facts) const {
  return settings_.diagnose_on_drift && facts.drift_since_unix_s > 0.0 &&
         facts.drift_lasts_s >= kDiagnosedDriftS && vehicle.diagnosed_revision != facts.revision;
}

/// For no longer than a retry takes, since the diagnosis may be refused or never begin.
bool UpkeepRules::AwaitsDiagnosis(const Vehicle& vehicle, const UpkeepFacts& facts,
                                  double now_unix_s) const {
  const bool begun = vehicle.diagnosed_revision == facts.revision;
  const auto since = begun ? vehicle.diagnosed_unix_s : facts.drift_since_unix_s;
  return settings_.diagnose_on_drift && facts.diagnosed_revision != facts.revision &&
         IsRecent(since, now_unix_s);
}

/// A clock that was put back by more makes no time recent.
bool UpkeepRules::IsRecent(std::optional<double> unix_s, double now_unix_s) const {
  return unix_s && std::abs(now_unix_s - *unix_s) < settings_.retry_s;
}

std::string UpkeepRules::RefreshReason(const Vehicle& vehicle, const UpkeepFacts& facts,
                                       double now_unix_s) const {
  const double age_s = now_unix_s - facts.published_unix_s;
  if (settings_.refresh_older_than_s > 0.0) {
    if (facts.revision == 0) return "it has no model";
    if (age_s > settings_.refresh_older_than_s) {
      return "its model is " + SpanText(age_s) + " old";
    }
  }
  if (settings_.refresh_on_drift && facts.drift_since_unix_s > 0.0 &&
      !AwaitsDiagnosis(vehicle, facts, now_unix_s)) {
    return fmt::format("revision {} no longer matches it", facts.revision);
  }
  if (Rounds(now_unix_s) > vehicle.rounds) {
    return "every " + SpanText(settings_.refresh_every_s);
  }
  return "";
}

double UpkeepRules::Rounds(double now_unix_s) const {
  if (settings_.refresh_every_s == 0.0) return 0.0;
  return std::floor((now_unix_s - start_unix_s_) / settings_.refresh_every_s);
}

}  // namespace telltale
