#include "telltale/service/monitoring/drift_monitor.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/drift/drift_constants.hpp"
#include "telltale/core/drift/known_thrust.hpp"

namespace telltale {
namespace {

// The filters of the preparation need rows on both sides, and segments a minimum length.
constexpr double kFilterLeadS = 15.0;
constexpr double kFilterTailS = 2.0;
constexpr double kReferenceS = 1200.0;
constexpr double kBlockS = static_cast<double>(kDrift.block_windows) * kDrift.window_s;
constexpr double kLongestBlockS = 2.0 * kBlockS;  // where telemetry comes faster than time

/// Leaves of each segment the rows in [from_s, to_s]. What led to them stays known.
void Restrict(PreparedDataset& dataset, double from_s, double to_s) {
  const auto later = [&](double time_s) {
    return static_cast<std::size_t>(
        std::ranges::lower_bound(dataset.rows, time_s, {}, &PreparedRow::time_s) -
        dataset.rows.begin());
  };
  const std::size_t first = later(from_s);
  const std::size_t last = later(to_s);
  for (RowRange& segment : dataset.segments) {
    segment.begin = std::clamp(first, segment.begin, segment.end);
    segment.end = std::clamp(last, segment.begin, segment.end);
  }
}

}  // namespace

void DriftMonitor::Follow(const Recording& recording, const Vehicle& vehicle,
                          const Identification& identification, const FreeRunError& normal) {
  const double settled_s = EndTime(recording) - kFilterTailS;
  const double new_s = settled_s - followed_to_s_;
  if (new_s >= 0.0 && new_s < kBlockS) return;
  const auto model = ModelOf(identification);
  if (!model) return;
  PrepareOptions options;
  options.sampling_period_s = identification.sampling_period_s;
  // A clock that went back begins anew with the newest block.
  const double block_s = std::clamp(new_s, kBlockS, kLongestBlockS);
  const double span_s = changes_ ? block_s : kReferenceS;
  auto dataset = Prepare(Latest(recording, span_s + kFilterTailS + kFilterLeadS), vehicle, options);
  followed_to_s_ = settled_s;
  if (!dataset) return;
  if (!commanded_error_) commanded_error_.emplace(normal);
  commanded_error_->Add(RunErrorsOf(*dataset, identification, settled_s - block_s));
  if (changes_) {
    Restrict(*dataset, settled_s - block_s, settled_s);
    changes_->Add(DriftEvidenceOf(*dataset, *model, *reference_));
  } else {
    knows_thrust_ = KnowsThrust(identification);
    if (knows_thrust_) reference_ = DriftReferenceOf(*dataset, *model);
    if (reference_) changes_.emplace(DriftEvidenceOf(*dataset, *model, *reference_));
  }
  NoteOnset(settled_s);
}

void DriftMonitor::NoteOnset(double settled_s) {
  const bool changed = changes_ && changes_->Fires();
  const bool errs = commanded_error_->Fires();
  change_onset_.Note(changed || (changes_ && changes_->Rises()), settled_s);
  error_onset_.Note(errs || commanded_error_->Rises(), settled_s);
  onset_.Note(
      {changed ? change_onset_.onset() : std::nullopt, errs ? error_onset_.onset() : std::nullopt});
}

std::string DriftMonitor::Pattern() const {
  if (!changes_ || !changes_->Fires()) return "";
  const std::vector<DriftFinding>& alarm = changes_->Alarm();
  std::string pattern = alarm.front().Describe();
  for (const DriftFinding& rival : std::span(alarm).subspan(1))
    pattern += " or " + rival.Describe();
  return pattern + (alarm.size() > 1 ? ", not yet separable" : "");
}

std::string DriftMonitor::Untested() const {
  if (changes_) return changes_->Untested();
  if (!knows_thrust_) return "every change: the model's thrust is smaller than its standard error";
  return "every change: no recording shows yet how the model errs while nothing has changed";
}

}  // namespace telltale
