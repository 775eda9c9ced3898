#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telltale/core/drift/change_estimate.hpp"
#include "telltale/core/drift/drift_evidence.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// A change that a boat's errors show.
struct DriftFinding {
  const Effect* effect = nullptr;
  double value = 0.0;  ///< of the parameter that is watched, less what the model erred before
  double standard_error = 0.0;
  double tolerance = 0.0;

  /// Standard errors by which the size is beyond the tolerance; negative within it.
  double Excess() const;
  /// "port thruster 14 % weaker".
  std::string Describe() const;
};

/// Whether a boat has changed since its model was made: the thrust of one side, the drag of the
/// hull, or the compass. Wind and current of any strength are no change, and neither are errors
/// that grow without a pattern. docs/concepts/diagnosis.md (101) to (103),
/// docs/validation/monitoring.md.
/// The model's own error is learnt over hours, while no change shows, and taken off within a bound.
/// Assumes: the boat steers and changes its speed. While it keeps to one course at one speed,
/// weather, the model's own error and changes of thrust and drag look alike, and count for nothing.
class DriftTest {
 public:
  DriftTest();

  void Add(const DriftEvidence& evidence);

  /// True from the time that a change is kDrift.alarm_sigmas standard errors beyond its tolerance
  /// until every change is within its own.
  bool Fires() const { return fires_; }

  /// Whether any change is beyond its tolerance. The time at which this began estimates the onset.
  bool Rises() const;

  /// The change with the most evidence; nothing until there are windows enough.
  std::optional<DriftFinding> Strongest() const;

 private:
  /// One change, as it is now and as it was over hours.
  struct Watched {
    WatchedChange change;
    ChangeEstimate now;
    ChangeEstimate before;
  };

  static Watched Watch(const WatchedChange& change, const Eigen::VectorXd& weather_precision);
  static DriftFinding FindingOf(const Watched& watched);

  std::vector<Watched> watched_;  ///< kDrift.changes, then the compass
  bool fires_ = false;
};

}  // namespace telltale
