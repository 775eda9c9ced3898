#include "telltale/service/monitoring/vehicle_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/service/monitoring/drift_advice.hpp"
#include "telltale/service/monitoring/quality_verdict.hpp"

namespace telltale {
namespace {

double Rate(Channel channel, const WindowState& now, const WindowState& before, double elapsed_s) {
  const auto i = static_cast<std::size_t>(channel);
  return static_cast<double>(now.arrived[i] - before.arrived[i]) / elapsed_s;
}

void WriteCounts(const WindowState& now, Quality& quality) {
  quality.window_s = now.end_s - now.start_s;
  quality.window_fill = now.fill;
  quality.lost = now.lost;
  quality.accepted = now.accepted;
  quality.rejected = RejectEntries(now.rejected);
  quality.shed = now.shed;
  quality.window_bytes = now.bytes;
}

/// What the window says of the telemetry alone.
Quality TelemetryQuality(const WindowState& now, const WindowState& before, double elapsed_s) {
  Quality quality;
  WriteCounts(now, quality);
  quality.gnss_rate_hz = Rate(Channel::kGnss, now, before, elapsed_s);
  quality.heading_rate_hz = Rate(Channel::kHeading, now, before, elapsed_s);
  quality.thrusters_rate_hz = Rate(Channel::kThrusters, now, before, elapsed_s);
  return quality;
}

std::optional<QualityPosition> PositionOf(const WindowState& state) {
  if (!state.newest_fix) return std::nullopt;
  QualityPosition position{state.newest_fix->latitude_deg, state.newest_fix->longitude_deg, {}};
  if (state.newest_heading) position.heading_deg = state.newest_heading->heading_deg;
  return position;
}

/// Median over the identified coefficients of half the width of their bounds, by their estimates.
double RelativeHalfWidth(const std::vector<Coefficient>& coefficients) {
  std::vector<double> widths;
  for (const Coefficient& c : coefficients) {
    if (c.status != CoefficientStatus::kEstimated || c.estimate == 0.0) continue;
    widths.push_back(0.5 * (c.interval.upper - c.interval.lower) / std::abs(c.estimate));
  }
  return widths.empty() ? 0.0 : Median(std::move(widths));
}

void WriteIdentifiability(const std::vector<Coefficient>& coefficients, Quality& quality) {
  quality.coefficients = static_cast<std::uint32_t>(coefficients.size());
  quality.identified = static_cast<std::uint32_t>(
      std::ranges::count(coefficients, CoefficientStatus::kEstimated, &Coefficient::status));
  const double width = RelativeHalfWidth(coefficients);
  quality.relative_half_width = std::isfinite(width) ? width : 0.0;
}

std::vector<ChannelDelay> DelaysOf(const Identification& identification) {
  std::vector<ChannelDelay> delays;
  if (!identification.physical) return delays;
  const auto add = [&](Channel channel, FossenParameter parameter) {
    const Coefficient& delay =
        identification.physical->parameters[static_cast<std::size_t>(At(parameter))];
    if (!std::isfinite(delay.interval.upper - delay.interval.lower)) return;
    delays.push_back({channel, delay.estimate, delay.interval.lower, delay.interval.upper});
  };
  add(Channel::kGnss, FossenParameter::kFixDelay);
  add(Channel::kThrusters, FossenParameter::kCommandDelay);
  return delays;
}

void WriteLastAnswers(const FleetView& view, Quality& quality) {
  quality.last_refusal = view.LastRefusalOf(quality.vehicle_id);
  const auto diagnosis = view.LastDiagnosisOf(quality.vehicle_id);
  quality.proposal = quality.drift_evidence.empty()
                         ? view.AdviceOf(quality.vehicle_id, quality.model_revision.value_or(0))
                         : DriftAdvice(quality, diagnosis.get());
  if (!diagnosis) return;
  quality.diagnosis_verdict = std::string(Name(diagnosis->diagnosis.verdict));
  quality.diagnosis_sentence = diagnosis->diagnosis.sentence;
  quality.diagnosed_unix_s = diagnosis->published_unix_s;
}

}  // namespace

Quality VehicleMonitor::Assess(VehicleWindow& window, const std::optional<StoredModel>& latest,
                               const FleetView& view, const std::optional<std::string>& store_fault,
                               double elapsed_s) {
  const WindowState state = window.State();
  Quality quality = TelemetryQuality(state, last_, elapsed_s);
  last_ = state;
  quality.vehicle_id = window.vehicle().vehicle_id;
  quality.sequence_number = ++published_;
  quality.position = PositionOf(state);
  UpdateEstimates(window, state);
  quality.indicative = indicative_;
  quality.indicative_rows = live_.rows();
  if (latest) AddModel(window, state.end_s, *latest, quality);
  WriteLastAnswers(view, quality);
  LogDrift(quality);
  Decide(state, view, store_fault, quality);
  assessed_ = std::move(quality);
  return assessed_;
}

Quality VehicleMonitor::Receipt(VehicleWindow& window) {
  WriteCounts(window.State(), assessed_);
  assessed_.vehicle_id = window.vehicle().vehicle_id;
  assessed_.sequence_number = ++published_;
  return assessed_;
}

void VehicleMonitor::AddModel(VehicleWindow& window, double end_s, const StoredModel& latest,
                              Quality& quality) {
  model_.Evaluate(window, end_s, latest);
  quality.model_revision = latest.model.revision;
  quality.model_age_s = UnixNow() - latest.model.published_unix_s;
  quality.prediction_error = model_.prediction_error();
  quality.drift = model_.drift();
  const auto onset = model_.DriftOnset();
  quality.drift_since_unix_s = onset ? onset->unix_s : 0.0;
  quality.drift_evidence = model_.DriftEvidence();
  quality.drift_untested = model_.DriftUntested();
  quality.model_verdict = latest.model.promotion;
  quality.delays = DelaysOf(latest.model.identification);
  WriteIdentifiability(latest.model.identification.coefficients, quality);
}

void VehicleMonitor::LogDrift(const Quality& quality) {
  const bool drifted = std::exchange(drifts_, !quality.drift_evidence.empty());
  if (!drifts_ || drifted) return;
  spdlog::warn("{}: {}; {}", quality.vehicle_id, quality.drift_evidence, quality.proposal);
}

void VehicleMonitor::Decide(const WindowState& state, const FleetView& view,
                            const std::optional<std::string>& store_fault, Quality& quality) {
  recent_.Note(state, RecentTelemetry::Clock::now());
  const LastMinute last = recent_.Summary();
  quality.silent_s = last.SilentS();
  quality.loss_share = last.LossShare();
  quality.reject_share = last.RejectShare();
  quality.shed_share = last.ShedShare();
  quality.reasons = ReasonsOf(quality, last, store_fault);
  AddSourceFaults(view.SourceFaults(), quality.reasons);
  quality.verdict = VerdictOf(quality.reasons);
  if (std::exchange(verdict_, quality.verdict) != quality.verdict) {
    verdict_since_unix_s_ = UnixNow();
  }
  quality.verdict_since_unix_s = verdict_since_unix_s_;
}

void VehicleMonitor::UpdateEstimates(VehicleWindow& window, const WindowState& state) {
  if (state.accepted == 0 || !live_.IsDue(state.end_s)) return;
  live_.Update(window.Snapshot(live_.NeedsS(state.end_s)), window.vehicle());
  indicative_ = live_.Estimates();
}

}  // namespace telltale
