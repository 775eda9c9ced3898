#include "telltale/service/monitoring/drift_monitor.hpp"

#include <algorithm>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/drift/drift_constants.hpp"

namespace telltale {
namespace {

// The filters of the preparation need rows on both sides, and segments a minimum length.
constexpr double kFilterLeadS = 15.0;
constexpr double kFilterTailS = 2.0;
constexpr double kLongestFollowedS = 1200.0;

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
                          const Identification& identification) {
  const auto model = ModelOf(identification);
  const double settled_s = EndTime(recording) - kFilterTailS;
  const double new_s = settled_s - followed_to_s_;
  if (!model || (reference_ && new_s >= 0.0 && new_s < kDrift.window_s)) return;
  PrepareOptions options;
  options.sampling_period_s = identification.sampling_period_s;
  // A clock that went back begins anew with the newest window.
  const double span_s =
      reference_ ? std::clamp(new_s, kDrift.window_s, kLongestFollowedS) : kLongestFollowedS;
  auto dataset = Prepare(Latest(recording, span_s + kFilterTailS + kFilterLeadS), vehicle, options);
  if (dataset && !reference_) {
    reference_ = DriftReferenceOf(*dataset, *model);
  } else if (dataset) {
    Restrict(*dataset, settled_s - span_s, settled_s);
    for (const DriftEvidence& evidence : DriftEvidenceOf(*dataset, *model, *reference_)) {
      test_.Add(evidence);
      onset_.Note(test_.Rises(), evidence.end_s);
      followed_to_s_ = evidence.end_s;
    }
  }
  // What no window covers now is passed over.
  if (settled_s < followed_to_s_ || settled_s >= followed_to_s_ + kDrift.window_s) {
    followed_to_s_ = settled_s;
  }
}

std::string DriftMonitor::Pattern() const {
  return Fires() ? test_.Strongest()->Describe() : "";
}

}  // namespace telltale
