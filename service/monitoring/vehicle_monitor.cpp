#include "telltale/service/monitoring/vehicle_monitor.hpp"

#include <utility>

#include "telltale/service/unix_now.hpp"

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

}  // namespace

Quality VehicleMonitor::Assess(VehicleWindow& window, const std::optional<StoredModel>& latest,
                               double elapsed_s) {
  const WindowState state = window.State();
  Quality quality = TelemetryQuality(state, last_, elapsed_s);
  last_ = state;
  quality.vehicle_id = window.vehicle().vehicle_id;
  quality.sequence_number = ++published_;
  assessed_ = Complete(window, state, latest, std::move(quality));
  return assessed_;
}

Quality VehicleMonitor::Receipt(VehicleWindow& window) {
  WriteCounts(window.State(), assessed_);
  assessed_.vehicle_id = window.vehicle().vehicle_id;
  assessed_.sequence_number = ++published_;
  return assessed_;
}

Quality VehicleMonitor::Complete(VehicleWindow& window, const WindowState& state,
                                 const std::optional<StoredModel>& latest, Quality quality) {
  UpdateEstimates(window, state);
  quality.indicative = indicative_;
  quality.indicative_rows = live_.rows();
  if (!latest) return quality;
  model_.Evaluate(window, state.end_s, *latest);
  quality.model_revision = latest->model.revision;
  quality.model_age_s = UnixNow() - latest->model.published_unix_s;
  quality.prediction_error = model_.prediction_error();
  quality.drift = model_.drift();
  quality.proposal = model_.Proposal(quality.vehicle_id);
  return quality;
}

void VehicleMonitor::UpdateEstimates(VehicleWindow& window, const WindowState& state) {
  if (state.accepted == 0 || !live_.IsDue(state.end_s)) return;
  live_.Update(window.Snapshot(), window.vehicle());
  indicative_ = live_.Estimates();
}

}  // namespace telltale
