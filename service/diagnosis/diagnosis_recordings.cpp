#include "telltale/service/diagnosis/diagnosis_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/service/monitoring/prediction_error.hpp"

namespace telltale {
namespace {

template <class Sample>
std::vector<Sample> Between(const std::vector<Sample>& samples, double from_s, double to_s) {
  const auto first = std::ranges::upper_bound(samples, from_s, {}, &Sample::time_s);
  const auto last = std::ranges::upper_bound(samples, to_s, {}, &Sample::time_s);
  return {first, std::max(first, last)};
}

/// Later than `from_s`, until `to_s`.
Recording Part(const Recording& recording, double from_s, double to_s) {
  return {Between(recording.gnss, from_s, to_s), Between(recording.heading, from_s, to_s),
          Between(recording.thrusters, from_s, to_s), recording.rejected};
}

double DurationS(const Recording& recording) {
  if (recording.gnss.empty()) return 0.0;
  return recording.gnss.back().time_s - recording.gnss.front().time_s;
}

std::string Seconds(double duration_s) {
  return std::to_string(static_cast<long>(std::floor(duration_s))) + " s";
}

}  // namespace

Result<DiagnosisRecordings> SelectDiagnosisRecordings(const Recording& window,
                                                      const PublishedModel& model,
                                                      const std::optional<Recording>& behind) {
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const double made_s = model.identification.window.end_s;
  const std::string revision = "revision " + std::to_string(model.revision);
  const bool same_clock = EndTime(window) >= made_s;
  DiagnosisRecordings live;
  live.since = same_clock ? Part(window, made_s, kEver) : window;
  if (DurationS(live.since) < kMinimumDiagnosedS) {
    return Refuse(model.identification.vehicle_id,
                  "has recorded only " + Seconds(DurationS(live.since)) + " since " + revision +
                      " was made, and a model is not held against the data that made it",
                  "ask again once a minute or more has been recorded");
  }
  live.baseline = behind;
  if (!live.baseline && same_clock) {
    live.baseline = Part(window, model.identification.window.start_s - 1.0, made_s);
  }
  if (live.baseline && DurationS(*live.baseline) < kMinimumDiagnosedS) live.baseline.reset();
  live.basis = live.baseline
                   ? "the baseline error is that on the " + Seconds(DurationS(*live.baseline)) +
                         " behind " + revision + ", which was fitted to them: it is a little low"
                   : "the data behind " + revision +
                         " are no longer held, so there is no baseline recording to compare with";
  return live;
}

}  // namespace telltale
