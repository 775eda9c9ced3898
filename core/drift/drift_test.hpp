#pragma once

#include <array>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telltale/core/drift/change_equations.hpp"
#include "telltale/core/drift/drift_constants.hpp"
#include "telltale/core/drift/drift_evidence.hpp"

namespace telltale {

/// A change that a boat's errors show.
struct DriftFinding {
  const WatchedChange* change = nullptr;
  double value = 0.0;  ///< of the parameter that is watched, beyond that of the reference
  double standard_error = 0.0;
  double explained = 0.0;  ///< weighted squares of the free runs' errors

  /// Standard errors by which the change is beyond its tolerance; negative within it.
  double Excess() const;
  bool IsBeyondDoubt() const { return Excess() >= change->alarm_sigmas; }
  /// "port thruster 14 % weaker".
  std::string Describe() const;
};

/// Whether a boat has changed since its model was made: the thrust of one side, the drag of the
/// hull, or the compass. Wind and current of any strength are no change, and neither are errors
/// that grow without a pattern.
/// Model: a test of each change against its tolerance, over the latest blocks, by estimates beside
/// which wind, current and a constant force are estimated anew; less the same of the reference,
/// which is what the model errs itself. docs/concepts/diagnosis.md (103) to (105). Its false
/// alarms: docs/validation/monitoring.md. Assumes: the boat steers and changes its speed. Where it
/// does not, nothing is said. Source: Lai, "Sequential changepoint detection in quality control and
/// dynamical systems", J. R. Statist. Soc. B 57 (1995), window-limited tests.
class DriftTest {
 public:
  /// By the windows of the reference, while nothing had changed.
  explicit DriftTest(std::span<const DriftEvidence> reference);

  /// The windows of one more block.
  void Add(std::span<const DriftEvidence> block);

  /// True from the time that a change is its alarm_sigmas standard errors beyond its tolerance
  /// until every change is within its own.
  bool Fires() const { return alarm_.has_value(); }

  /// Whether any change is beyond its tolerance. The time at which this began estimates the onset.
  bool Rises() const { return strongest_ && strongest_->Excess() > 0.0; }

  /// Of the changes that were last beyond doubt the one that explains the errors best; nothing
  /// while it does not fire. A large change makes others seem to be there.
  const std::optional<DriftFinding>& Alarm() const { return alarm_; }

 private:
  std::vector<DriftFinding> FindingsOf(const DriftEvidence& latest) const;

  std::array<ChangeInformation, kDrift.changes.size()> reference_;
  std::deque<DriftEvidence> blocks_;  ///< oldest first, no more than the longest of kDrift.spans
  std::optional<DriftFinding> strongest_;  ///< now; nothing where blocks tell too little of all
  std::optional<DriftFinding> alarm_;
};

}  // namespace telltale
