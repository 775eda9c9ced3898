#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telltale/core/drift/change_equations.hpp"
#include "telltale/core/drift/drift_constants.hpp"
#include "telltale/core/drift/drift_evidence.hpp"

namespace telltale {

/// A change that a boat's errors show, beyond what the reference shows of it.
struct DriftFinding {
  const WatchedChange* change = nullptr;
  double value = 0.0;  ///< of the parameter that is watched
  double least = 0.0;  ///< the same without the block on which most of it rests
  double standard_error = 0.0;
  double explained = 0.0;  ///< weighted squares of the errors

  /// Standard errors by which the change is beyond its tolerance; negative within it.
  double Excess() const;
  /// Whether it is so by its alarm_sigmas whichever block is left out: no minute decides alone.
  bool IsBeyondDoubt() const;
  /// "port thruster 14 % weaker".
  std::string Describe() const;
};

/// Whether a boat has changed since its model was made: the thrust of one side, the drag of the
/// hull, or the compass. Wind and current of any strength are no change, and neither are errors
/// that grow without a pattern, nor what a single block shows.
/// Model: a test of each change against its tolerance, over the latest blocks, by estimates beside
/// which wind, current and a constant force are estimated anew; less what the model errs itself,
/// as the same of the reference predicts it. docs/concepts/diagnosis.md (124) to (126). Its false
/// alarms: docs/validation/monitoring.md. Assumes: the boat steers and changes its speed. Where it
/// does not, nothing is said. Sources: Lai, "Sequential changepoint detection in quality control
/// and dynamical systems", J. R. Statist. Soc. B 57 (1995), window-limited tests; Efron, "The
/// jackknife, the bootstrap and other resampling plans", SIAM (1982), blocks left out.
class DriftTest {
 public:
  /// By the windows of the reference, while nothing had changed.
  explicit DriftTest(std::span<const DriftEvidence> reference);

  /// The windows of one more block.
  void Add(std::span<const DriftEvidence> block);

  /// True from the second block in succession with which a change is beyond doubt until every
  /// change is within its tolerance.
  bool Fires() const { return !alarm_.empty(); }

  /// Whether any change is beyond its tolerance. The time at which this began estimates the onset.
  bool Rises() const { return strongest_ && strongest_->Excess() > 0.0; }

  /// Of the changes that were last beyond doubt the one that explains the errors best, then those
  /// beyond their tolerance that explain them nearly as well; nothing while it does not fire. A
  /// large change makes others seem to be there.
  const std::vector<DriftFinding>& Alarm() const { return alarm_; }

  /// What the latest blocks do not tell, and why, for people: "drag, compass: commands and heading
  /// have varied too little"; empty where every change is tested.
  std::string Untested() const;

 private:
  /// What a span shows of each change that it tells enough of.
  struct Findings {
    std::vector<DriftFinding> of_changes;
    bool follow_no_pattern = false;  ///< errors are too large for any to count
  };

  Findings FindingsOf(std::span<const DriftEvidence> blocks) const;
  void NoteTested(const Findings& findings);

  std::array<ChangeInformation, kDrift.changes.size()> reference_;  ///< what the model errs itself
  std::vector<DriftEvidence> blocks_;  ///< oldest first, no more than the longest of kDrift.spans
  std::optional<DriftFinding> strongest_;  ///< now; nothing where blocks tell too little of all
  bool was_beyond_doubt_ = false;          ///< with the block before
  std::vector<DriftFinding> alarm_;
  std::array<bool, kDrift.changes.size()> is_tested_{};  ///< now, over any span
  bool follow_no_pattern_ = false;                       ///< the errors now, over every span
};

}  // namespace telltale
