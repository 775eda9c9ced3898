#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "telltale/service/ingest/vehicle_window.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/monitoring/drift_monitor.hpp"
#include "telltale/service/monitoring/onset_clock.hpp"

namespace telltale {

/// How well the latest model of a vehicle predicts the newest minute, and whether the vehicle has
/// drifted from it. A new revision starts anew. Not thread safe.
class ModelMonitor {
 public:
  /// Evaluates the model on the last minute of the window, which ends at `end_s` of the vehicle's
  /// clock. Does nothing where less than 5 s have come since the last evaluation, unless the clock
  /// went back, and for a model without a reference error.
  void Evaluate(VehicleWindow& window, double end_s, const StoredModel& model);

  /// The free-run error over 5 s in units of that when the model was made; 0 where not evaluated.
  double prediction_error() const { return prediction_error_.value_or(0.0); }

  /// The running mean of the change of prediction_error() per evaluation.
  double drift() const { return drift_; }

  /// The onset of the drift, while there is one.
  const std::optional<OnsetTime>& DriftOnset() const { return drift_monitor_.onset(); }

  /// What shows the drift, for people; empty where there is none.
  std::string DriftEvidence() const;

  /// Of which changes it cannot tell now, and why, for people; empty where it tests all.
  std::string DriftUntested() const { return drift_monitor_.Untested(); }

 private:
  void Add(double relative_error);

  std::uint64_t revision_ = 0;   ///< of the model evaluated
  double evaluated_to_s_ = 0.0;  ///< the vehicle's time of the newest sample evaluated
  std::optional<double> prediction_error_;
  double drift_ = 0.0;
  DriftMonitor drift_monitor_;
};

}  // namespace telltale
