#include "telltale/service/diagnosis/diagnosis_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/diagnosis/diagnose.hpp"

namespace telltale {
namespace {

double DurationS(const Recording& recording) {
  if (recording.gnss.empty()) return 0.0;
  return recording.gnss.back().time_s - recording.gnss.front().time_s;
}

std::string Seconds(double duration_s) {
  return std::to_string(static_cast<long>(std::floor(duration_s))) + " s";
}

void LeaveOutBefore(double drift_onset_s, DiagnosisRecordings& live) {
  Recording since_onset =
      Between(live.since, drift_onset_s, std::numeric_limits<double>::infinity());
  const double left_out_s = DurationS(live.since) - DurationS(since_onset);
  if (DurationS(since_onset) < kMinimumDiagnosedS || left_out_s < 1.0) return;
  live.since = std::move(since_onset);
  live.left_out = "the error began to rise " + Seconds(DurationS(live.since)) +
                  " before the end; the " + Seconds(left_out_s) + " before that are left out";
}

}  // namespace

Result<DiagnosisRecordings> SelectDiagnosisRecordings(const Recording& window,
                                                      const PublishedModel& model,
                                                      const std::optional<Recording>& behind,
                                                      std::optional<double> drift_onset_s) {
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const double made_s = model.identification.window.end_s;
  const std::string revision = "revision " + std::to_string(model.revision);
  const bool same_clock = EndTime(window) >= made_s;
  DiagnosisRecordings live;
  live.since = same_clock ? Between(window, made_s, kEver) : window;
  if (DurationS(live.since) < kMinimumDiagnosedS) {
    return Refuse(model.identification.vehicle_id,
                  "has recorded only " + Seconds(DurationS(live.since)) + " since " + revision +
                      " was made, and a diagnosis needs data that did not make the model",
                  "ask again once a minute or more has been recorded");
  }
  if (drift_onset_s && same_clock) LeaveOutBefore(*drift_onset_s, live);
  live.baseline = behind;
  if (!live.baseline && same_clock) {
    live.baseline = Between(window, model.identification.window.start_s - 1.0, made_s);
  }
  if (live.baseline && DurationS(*live.baseline) < kMinimumDiagnosedS) live.baseline.reset();
  live.basis = live.baseline
                   ? "the baseline error is that on the " + Seconds(DurationS(*live.baseline)) +
                         " behind " + revision + ", which was fitted to them, so it is a little low"
                   : "the daemon no longer holds the data behind " + revision +
                         ", so there is no baseline recording to compare with";
  return live;
}

}  // namespace telltale
